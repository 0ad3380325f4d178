"""Random bicubic bases that face each other: gap, exit angles, twist, speeds and domains at random."""

import numpy as np

from helpers.bases import random_knots
from semispline import Base, BSplineSurface


def random_facing(rng, *, least_angle=0.0, most_angle=80.0, wave=0.05, most_yaw=0.0):
    """Return two bases whose contacts, about 1 long, face each other; exits leave by angles of either sign, in degrees.

    The gap is .2 to 2 contact lengths; the parameter across runs over decades. A yaw, in degrees, turns the second base
    so that the gap grows along the contact.
    """
    gap = np.exp(rng.uniform(np.log(0.2), np.log(2.0)))
    offset = np.array([gap, rng.uniform(-0.2, 0.2), rng.uniform(-0.3, 0.3) * gap])
    twist = np.radians(rng.uniform(-20, 20))
    turn = np.array([[1, 0, 0], [0, np.cos(twist), -np.sin(twist)], [0, np.sin(twist), np.cos(twist)]])
    yaw = np.radians(rng.uniform(-most_yaw, most_yaw))
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]) @ turn
    # About the middle of the contact, as far as the gap allows.
    offset = offset + (np.eye(3) - turn) @ [0, 0.5, 0] + [abs(np.sin(yaw)) / 2, 0, 0]
    bases = []
    for side in range(2):
        angle = np.radians(rng.uniform(least_angle, most_angle)) * rng.choice([-1, 1])
        # Into the base: away from the other one, tilted.
        inward = np.array([-np.cos(angle), 0, np.sin(angle)])
        net = _net(rng, inward, wave, rng.integers(0, 3), rng.integers(0, 6))
        if side == 1:
            net = net._replace(points=(net.points * [-1, 1, 1]) @ turn.T + offset)
        bases.append(Base(BSplineSurface(3, 3, net.knots_u, net.knots_v, net.points), "u0"))
    return tuple(bases)


def _net(rng, inward, wave, across, along):
    from collections import namedtuple

    start, length = rng.uniform(-1, 1), 10.0 ** rng.uniform(-1.5, 1.5)
    knots_u = random_knots(rng, 3, 4 + int(across), start, start + length)
    knots_v = random_knots(rng, 3, 4 + int(along), 0.0, 10.0 ** rng.uniform(-1, 1))
    depth = rng.uniform(0.5, 1.5)

    def greville(knots):
        means = np.array([knots[i + 1 : i + 4].mean() for i in range(len(knots) - 4)])
        return (means - knots[0]) / (knots[-1] - knots[0])

    w, v = np.meshgrid(greville(knots_u), greville(knots_v), indexing="ij")
    points = depth * w[..., None] * inward + v[..., None] * np.array([0.0, 1, 0])
    # Smooth waves: a bend along the contact, one across, and a little noise.
    normal = np.cross(inward, [0.0, 1, 0])
    bend = rng.uniform(-1, 1, 3) * wave * np.array([2.0, 3.0, 1.0])
    height = bend[0] * np.sin(np.pi * v) + bend[1] * w**2 + bend[2] * np.cos(2 * np.pi * v) * (1 + w)
    points = points + height[..., None] * normal + 0.05 * wave * rng.uniform(-1, 1, points.shape)
    return namedtuple("Net", "knots_u knots_v points")(knots_u, knots_v, points)
