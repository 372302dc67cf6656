"""Two bent beams and a joint by finite elements of one global matrix: the reference for whole assemblies.

Euler and Bernoulli's elements with consistent masses (w, θ at each node). Damping is modal in each beam: the global
matrix has M Φ diag(2ζω) Φᵀ M of each beam alone.
"""

import numpy as np
from scipy.linalg import block_diag, eigh

WIDTH, HEIGHT, YOUNG, DENSITY = 0.03, 0.006, 70e9, 2700.0
RATIO = 0.005


def beam(length, elements):
    """M and K of a free beam."""
    area, inertia = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12
    step = length / elements
    stiffness = np.array([[12, 6 * step, -12, 6 * step], [6 * step, 4 * step**2, -6 * step, 2 * step**2],
                          [-12, -6 * step, 12, -6 * step], [6 * step, 2 * step**2, -6 * step, 4 * step**2]])
    mass = np.array([[156, 22 * step, 54, -13 * step], [22 * step, 4 * step**2, 13 * step, -3 * step**2],
                     [54, 13 * step, 156, -22 * step], [-13 * step, -3 * step**2, -22 * step, 4 * step**2]])
    size = 2 * (elements + 1)
    whole_m, whole_k = np.zeros((size, size)), np.zeros((size, size))
    for element in range(elements):
        own = slice(2 * element, 2 * element + 4)
        whole_k[own, own] += YOUNG * inertia / step**3 * stiffness
        whole_m[own, own] += DENSITY * area * step / 420 * mass
    return whole_m, whole_k


def damped(mass, stiffness, free):
    """C of a beam with the same ratio in all elastic modes."""
    squares, shapes = eigh(stiffness, mass)
    squares[:free] = 0
    own = 2 * RATIO * np.sqrt(squares)
    left = mass @ shapes
    return left @ np.diag(own) @ left.T


def clamped(matrix):
    return matrix[2:, 2:]


class TwoBeams:
    """A clamped at its first end and B free, joined tip to start on w and θ."""

    def __init__(self, elements=(60, 67), lengths=(0.300, 0.335)):
        a_mass, a_stiffness = (clamped(own) for own in beam(lengths[0], elements[0]))
        b_mass, b_stiffness = beam(lengths[1], elements[1])
        self.a = (a_mass, damped(a_mass, a_stiffness, 0), a_stiffness)
        self.b = (b_mass, damped(b_mass, b_stiffness, 2), b_stiffness)
        self.mass, self.damping, self.stiffness = (block_diag(a, b) for a, b in zip(self.a, self.b))
        size_a, size = len(a_mass), len(self.mass)
        self.size_a, self.size = size_a, size
        # w and θ at the joint on A (its last node) and on B (its first), and w at B's last node
        self.relative = np.zeros((2, size))
        self.relative[0, size_a - 2], self.relative[1, size_a - 1] = 1, 1
        self.relative[0, size_a], self.relative[1, size_a + 1] = -1, -1
        self.tip = np.zeros(size)
        self.tip[size - 2] = 1

    def joined(self, stiffness, damping):
        """M, C and K with the joint."""
        s = self.relative
        return self.mass, self.damping + s.T @ damping @ s, self.stiffness + s.T @ stiffness @ s
