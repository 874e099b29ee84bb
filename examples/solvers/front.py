#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Carries a cloud once around a disc, on meshes that follow its front: front.py [--quads N] [--meshes M] [-o PICTURE.svg]

The front is 0.1 wide; the disc of two regions turns under it. Elements are bilinear, the rule is Crank and Nicolson's. Diffusion is
1e-5, and nothing flows through the rim, so that the mass stays. Each mesh is made from the one before, without the model. It is
fine at the present cloud, and at the cloud that a try on the old mesh predicts. On the same meshes each way of transfer carries the
values. Needs numpy, scipy and the Python module delquad.
"""

import math
import time

import delquad
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import driver
from adapt_poisson import places

DIFFUSION = 1e-5


def moved(mesh, u, period, steps):
    """After each half of a period, which are so many steps each. A turn takes 1."""
    mass, motion = np.zeros((2, len(mesh.quads), 4, 4))
    for shape, slopes, at, weight in places(mesh, 3):
        velocity = 2 * math.pi * np.stack([-at[:, 1], at[:, 0]], axis=1)
        mass += np.einsum("e,k,l->ekl", weight, shape, shape)
        motion += np.einsum("e,eb,ebk,l->ekl", weight, velocity, slopes, shape)
        motion -= DIFFUSION * np.einsum("e,eak,eal->ekl", weight, slopes, slopes)
    at = np.repeat(mesh.quads, 4, axis=1).ravel(), np.tile(mesh.quads, 4).ravel()
    mass, motion = (scipy.sparse.csc_matrix((part.ravel(), at), (len(u), len(u))) for part in (mass, motion))
    step = period / (2 * steps)
    system = scipy.sparse.linalg.splu(mass - step / 2 * motion)
    halves = []
    for _ in range(2):
        for _ in range(steps):
            u = u + system.solve(step * (motion @ u))
        halves.append(u)
    return halves


def total(mesh, u):
    return sum(weight @ (u[mesh.quads] @ shape) for shape, _, _, weight in places(mesh, 2))


def cloud(mesh):
    return (1 - np.tanh((np.hypot(mesh.points[:, 0] - 0.45, mesh.points[:, 1]) - 0.3) / 0.05)) / 2


def disc():
    def half(name, turned):
        rim = delquad.arc((0, 0), 1, turned, turned + math.pi, "rim")
        return delquad.loop([rim, delquad.segment((0, 1), (0, -1), "seam")], name)

    return delquad.planar([half("left", math.pi / 2), half("right", -math.pi / 2)])


def off_rim(mesh):
    """How far the farthest node of the rim is from the circle."""
    rim = [k for k, (_, names) in enumerate(mesh.curves) if "rim" in names]
    return abs(np.hypot(*mesh.points[np.unique(mesh.lines[np.isin(mesh.line_curve, rim)]), :2].T) - 1).max()


def main():
    options = driver.parser(__doc__, "front.svg", quads=400, meshes=50).parse_args()
    settings = {"quads": options.quads, "max_size": 0.25, "quality": "fast"}  # on longer sides the circle is lost
    began = time.perf_counter()
    mesh = delquad.mesh(disc(), quads=options.quads)
    for _ in range(3):
        mesh, _ = delquad.adapt(mesh, cloud(mesh), **settings)
    clouds = dict.fromkeys(("interpolated", "conservative", "bounded"), cloud(mesh))
    mass, names, quads = total(mesh, cloud(mesh)), (mesh.curves, mesh.regions), 0
    beyond = dict.fromkeys(clouds, 0)
    for _ in range(options.meshes):
        now = clouds["bounded"]
        halfway, ahead = moved(mesh, now, 1 / options.meshes, 4)
        following, _ = delquad.adapt(mesh, {"now": now, "halfway": halfway, "ahead": ahead}, **settings)
        for how, u in clouds.items():
            brought = delquad.transfer(mesh, u, following, how)
            beyond[how] = max(beyond[how], u.min() - brought.min(), brought.max() - u.max())
            clouds[how] = moved(following, brought, 1 / options.meshes, 4)[1]
        mesh = following
        quads += len(mesh.quads) / options.meshes
    print(f"{options.meshes} meshes of {quads:.0f} quads, {time.perf_counter() - began:.1f} s")
    print(f"names: {'the same' if (mesh.curves, mesh.regions) == names else 'others'}")
    print(f"nodes of the rim off the circle: {off_rim(mesh):.1e}")
    print("transfer      mass changes by   least    most  beyond extremes")
    for how, u in clouds.items():
        print(f"{how:13} {total(mesh, u) / mass - 1:15.1e} {u.min():7.3f} {u.max():7.3f} {beyond[how]:16.1e}")
    driver.draw(mesh, clouds["bounded"], options.output, "cloud")


if __name__ == "__main__":
    main()
