# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the Python package by CMake: pip install --no-build-isolation ."""

import os
import pathlib
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class Build(build_ext):
    """The module and its Python files, as program/python/CMakeLists.txt installs them."""

    def build_extension(self, ext):
        source = pathlib.Path(__file__).resolve().parent
        build = pathlib.Path(self.build_temp).resolve()
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent.parent
        installed = os.environ.get("DELQUAD_INSTALLED")  # what cmake/packaging/package.sh has built and given its libraries
        if installed:
            shutil.copytree(installed, target / "delquad", dirs_exist_ok=True)
            return
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON", "-DDELQUAD_PYTHON=ON",
                   "-DDELQUAD_PYTHON_DESTINATION=.", f"-DPython3_EXECUTABLE={sys.executable}"]
        options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        for command in (
            ["-S", source, "-B", build, "-G", "Ninja", *options],
            ["--build", build, "--target", "delquad_python"],
            ["--install", build, "--component", "python", "--prefix", target],
        ):
            subprocess.run(["cmake", *command], check=True)


setup(ext_modules=[Extension("delquad._core", [])], cmdclass={"build_ext": Build})
