#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# package.sh BUILD OUT: makes of what is built in BUILD three Debian packages and, with the libraries of other projects, so that they
# run where these are not installed and wherever they lie, an archive and a Python wheel.
set -eu
cd "$(dirname "$0")/../.."
mkdir -p "$2"
build=$(realpath "$1") out=$(realpath "$2")
work=$out/work
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
rm -rf "$work" "$out"/*.deb "$out"/*.tar.xz "$out"/*.whl

cpack --config "$build/CPackConfig.cmake" -B "$work"
mv "$work"/*.deb "$out"

version=$("$build/delquad" --version | cut -d' ' -f2)
archive=$work/delquad-$version-linux-$(uname -m)
for component in program library; do
  cmake --install "$build" --component $component --prefix "$archive" --strip >/dev/null
done
cmake --install "$build" --component python --prefix "$work/python" --strip >/dev/null
module=$(dirname "$(find "$work/python" -name '_core*')")
ours=$(find "$archive" "$module" -type f \( -path '*/bin/*' -o -name 'delquad-cad' -o -name '*.so*' \))

# Not glibc and the C++ library, which a process has once. The others become delquad-NAME, as it may have another NAME.
# shellcheck disable=SC2086
needed=$(ldd $ours | awk '$2 == "=>" { print $3 }' | sort -u |
  grep -vE '/lib(c|m|dl|rt|pthread|util|resolv|anl|mvec|stdc\+\+|gcc_s|delquad[-_a-z]*)\.so')
libraries=$archive/lib/delquad
mkdir "$libraries"
renamed=""
for library in $needed; do
  name=$(basename "$library")
  cp -L "$library" "$libraries/delquad-$name"
  renamed="$renamed --replace-needed $name delquad-$name"
done
strip --strip-unneeded "$libraries"/*
for file in "$libraries"/*; do
  patchelf --set-soname "$(basename "$file")" "$file"
done
for file in "$libraries"/* $ours; do  # in two steps: patchelf 0.14 mixes them up
  # shellcheck disable=SC2086
  patchelf $renamed "$file"
  patchelf --force-rpath --set-rpath "\$ORIGIN:\$ORIGIN/libs:\$ORIGIN/delquad:\$ORIGIN/../lib:\$ORIGIN/../lib/delquad" "$file"
done

# Their licences.
licences=$archive/share/doc/delquad/licences
mkdir "$licences"
for library in $needed; do
  file=$(realpath "$library")
  dpkg-query -S "$file" "${file#/usr}" 2>/dev/null | cut -d: -f1 | grep . ||
    { echo "$file is of no Debian package: its licence is not known" >&2; exit 1; }
done >"$work/packages"
sort -u -o "$work/packages" "$work/packages"
while read -r package; do
  cp -L "/usr/share/doc/$package/copyright" "$licences/$package"
done <"$work/packages"
# shellcheck disable=SC2016
xargs dpkg-query -W -f '${Package} ${Version} ${Homepage}\n' <"$work/packages" >"$licences/PACKAGES"

tar -C "$work" -c "$(basename "$archive")" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" |
  xz -T0 >"$out/$(basename "$archive").tar.xz"

cp -r "$libraries" "$module/libs"
cp -r "$licences" "$module"
# What is built on a machine needs no newer glibc.
tag=manylinux_$(getconf GNU_LIBC_VERSION | cut -d' ' -f2 | tr . _)_$(uname -m)
python=$(sed -n 's/^_Python3_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
DELQUAD_INSTALLED=$module "$python" setup.py -q egg_info -e "$work" build -b "$work/wheel" bdist_wheel -p "$tag" -d "$out" 2>"$work/log" ||
  { cat "$work/log" >&2; exit 1; }
rm -rf "$work"
ls -sh "$out"
