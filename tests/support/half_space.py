"""An independent solution of the elastic problem in NumPy. It shares no code with the program.

H = H0 + r^2/2 + 2 s Int P(H(t)) k(r, t) t dt on fixed Gauss-Legendre panels, by Newton's method and
continuation in the gap on the axis. Lengths are in units of the law's length; s is sigma or Lambda.
"""

import ctypes
import ctypes.util
import functools

import numpy as np
from numpy.polynomial import chebyshev
from support.abel import lagrange
from support.calculus import gauss


def agm_k(complement):
    """Complete elliptic integral K from sqrt(1 - m), by the arithmetic-geometric mean."""
    a, b = np.ones_like(complement), complement
    for _ in range(40):
        a, b = (a + b) / 2, np.sqrt(a * b)
        if np.all(abs(a - b) <= 1e-15 * a):
            break
    return np.pi / (2 * a)


def kernel(r, t, distance):
    """k(r, t); |r - t| is an argument to avoid cancellation."""
    large = np.maximum(r, t)
    complement = np.sqrt(distance / large * (1 + np.minimum(r, t) / large))
    return 4 / (np.pi * large) * agm_k(complement)


def ring_image(r, t, depth):
    """2 Int exp(-depth k) J0(k r) J0(k t) dk: the kernel of an image at a depth."""
    far, near = np.hypot(r + t, depth), np.hypot(r - t, depth)
    return 4 / (np.pi * far) * agm_k(near / far)


def waves_of_layer(a, ratio, nu, base):
    """L at a = k t of a layer on a base, from Burmister's solution; ratio: of the shear moduli,
    layer over base, 0 for a rigid base."""
    fade = np.exp(-2 * a)
    if ratio:
        lam = 1 - 4 * (1 - nu) / (1 + ratio * (3 - 4 * base))
        kap = (ratio - 1) / (ratio + 3 - 4 * nu)
    else:
        lam, kap = 4 * nu - 3, -1 / (3 - 4 * nu)
    return ((1 + 4 * a * kap * fade - lam * kap * fade**2)
            / (1 - (lam + kap + 4 * kap * a**2) * fade + lam * kap * fade**2))


def layer_image(r, t, layer):
    """2 Int (L - 1) J0(k r) J0(k t) dk for layer: thickness, ratio of moduli, Poisson's ratios of
    layer and base, and the part of the bodies' compliance that has the layer."""
    near = 12
    if r.max() > near:
        # At large radii only the base has an effect, and the small pressures there matter little.
        image = layer_image_to(5 / layer[0], r, t, layer)
        image[np.ix_(r <= near, t <= near)] = layer_image_to(20 / layer[0], r[r <= near],
                                                             t[t <= near], layer)
        return image
    return layer_image_to(20 / layer[0], r, t, layer)


def layer_image_to(last, r, t, layer):
    """The integral up to k = last; beyond 20 over the thickness, exp(-40) is neglected."""
    thickness, ratio, nu, base, part = layer
    x, w = gauss(16)
    # Panels are short for the waves and, near 0, for stiff layers.
    length = min(0.5 / thickness, 10 / max(r.max(), t.max()))
    ends = np.concatenate([length * 0.5 ** np.arange(12, 0, -1), np.arange(length, last, length)])
    ends = np.concatenate([[0], ends])
    k = (ends[:-1, None] + np.diff(ends)[:, None] * x).ravel()
    weight = (np.diff(ends)[:, None] * w).ravel()
    strength = 2 * part * weight * (waves_of_layer(k * thickness, ratio, nu, base) - 1)
    return (bessel_j0(np.outer(r, k)) * strength) @ bessel_j0(np.outer(t, k)).T


def bessel_j0(x):
    j0 = ctypes.CDLL(ctypes.util.find_library("m")).j0
    j0.argtypes, j0.restype = [ctypes.c_double], ctypes.c_double
    return np.fromiter(map(j0, x.ravel().tolist()), float, x.size).reshape(x.shape)


class HalfSpace:
    """Panels and the matrix of the kernel on them; row 0 is the axis.

    image: strength and depth of a ring image that is added to the kernel; layer: as in
    `layer_image`.
    """

    def __init__(self, ends, order=12, image=None, layer=None):
        local, weight = gauss(order)
        ends = np.asarray(ends, float)
        length = np.diff(ends)[:, None]
        self.r = (ends[:-1, None] + length * local).ravel()
        self.weight = (length * weight).ravel() * self.r
        self.end = ends[-1]
        targets = np.concatenate([[0.0], self.r])
        self.matrix = np.empty((len(targets), len(self.r)))
        s, v = gauss(40)
        for panel, (a, b) in enumerate(zip(ends[:-1], ends[1:])):
            columns = slice(panel * order, (panel + 1) * order)
            t = self.r[columns]
            far = (targets < a - (b - a)) | (targets > b + (b - a))
            r = targets[far, None]
            self.matrix[far, columns] = kernel(r, t, abs(r - t)) * weight * (b - a) * t
            # Graded as the sixth power towards the point nearest to the target.
            self.matrix[~far, columns] = 0
            nearest = np.clip(targets, a, b)
            for side, reach in ((-1, nearest - a), (1, b - nearest)):
                rows = np.flatnonzero(~far & (reach > 0))
                target, near, length = (x[rows, None] for x in (targets, nearest, reach))
                offset = side * length * s**6
                at = near + offset
                k = kernel(target, at, abs((near - target) + offset))
                self.matrix[rows, columns] += np.einsum(
                    "iq,iqj->ij", k * 6 * s**5 * v * length * at,
                    lagrange((at - a) / (b - a), order))
        if image:
            strength, depth = image
            self.matrix += strength * ring_image(targets[:, None], self.r, depth) * self.weight
        if layer:
            self.matrix += layer_image(targets, self.r, layer) * self.weight

    def with_axis(self, law, s, axis):
        """The gaps and H0 for each of several gaps on the axis, from large gaps inwards.

        The gap on the axis is given and H0 is unknown, so folds in H0 are regular states.
        """
        r = np.concatenate([[0.0], self.r])
        shape, gap, h0 = r**2 / 2, axis[0] + r**2 / 2, axis[0]
        nodes, jacobian = np.arange(len(r)), np.empty((len(r), len(r)))
        found = []
        for value in axis:
            if len(found) < 2:
                gap = gap + (value - gap[0])
            else:
                # Begun as the gaps changed last.
                before = found[-2][0]
                gap = gap * (gap / before) ** ((value - gap[0]) / (gap[0] - before[0]))
                gap[0] = value
            for _ in range(60):
                pressure, slope, _ = law(gap[1:])
                residual = gap - h0 - shape - 2 * s * self.matrix @ pressure
                # The first column is that of H0, since the gap on the axis is constant.
                jacobian[:, 1:] = self.matrix * (-2 * s * slope)
                jacobian[nodes, nodes] += 1
                jacobian[:, 0] = -1
                step = np.linalg.solve(jacobian, -residual)
                h0 += step[0]
                step[0] = 0
                gap = np.maximum(gap + step, 0.7 * gap)
                # What is left is the square of the step.
                if abs(step).max() < 1e-8 * max(1, abs(h0)):
                    break
            else:
                raise ArithmeticError(f"no solution at {value}")
            found.append((gap, h0))
        return found

    def from_gaps(self, law, s, h0, r, gap):
        """The gaps (axis first) at H0 by Newton's method, from gaps at the positions r."""
        nodes = np.concatenate([[0.0], self.r])
        undeformed = h0 + nodes**2 / 2
        gap = undeformed + np.interp(nodes, r, gap - h0 - r**2 / 2)
        for _ in range(12):
            pressure, slope, _ = law(gap[1:])
            jacobian = np.eye(len(nodes))
            jacobian[:, 1:] -= 2 * s * self.matrix * slope
            step = np.linalg.solve(jacobian, undeformed - gap + 2 * s * self.matrix @ pressure)
            gap += step
        assert abs(step).max() < 1e-9
        return gap

    def folds(self, law, s, axis, states, softness):
        """H0 and load where H0 - softness*load turns, from the states at the gaps on the axis."""
        def driven(states):
            return np.array([h0 - softness * self.load(law, s, gap) for gap, h0 in states])

        drive = driven(states)
        turns = np.flatnonzero(np.diff(drive)[1:] * np.diff(drive)[:-1] < 0) + 1
        found = []
        for i in turns:
            low, high = axis[i + 1], axis[i - 1]
            at = (low + high) / 2 + (high - low) / 2 * chebyshev.chebpts1(12)[::-1]
            near = self.with_axis(law, s, [*axis[:i:4], *at])[-12:]
            u = chebyshev.chebpts1(12)[::-1]
            h0_of = chebyshev.chebfit(u, [state[1] for state in near], 11)
            load_of = chebyshev.chebfit(u, [self.load(law, s, state[0]) for state in near], 11)
            roots = chebyshev.chebroots(chebyshev.chebder(chebyshev.chebfit(u, driven(near), 11)))
            root = roots[(abs(roots.imag) < 1e-9) & (abs(roots.real) <= 1)].real[0]
            found.append([chebyshev.chebval(root, h0_of), chebyshev.chebval(root, load_of)])
        return found

    def load(self, law, s, gap):
        """The load; the deformation is assumed to be constant beyond the mesh."""
        pressure, _, _ = law(gap[1:])
        _, _, energy = law(np.array([gap[-1] + (self.end**2 - self.r[-1] ** 2) / 2]))
        return 2 * np.pi * s * (self.weight @ pressure + energy[0])


def exponential(gap):
    p = np.exp(-gap)
    return p, -p, p


def lennard_jones(gap):
    return (
        8 / 3 * (gap**-9 - gap**-3), 8 * (gap**-4 - 3 * gap**-10), gap**-8 / 3 - 4 / 3 * gap**-2)


def behind_a_barrier(gap):
    """The Lennard-Jones law and an exponential repulsion of ten times its range."""
    push = 0.03 * np.exp(-gap / 10)
    return tuple(one + more for one, more in zip(lennard_jones(gap), (push, -push / 10, 10 * push)))


def sticky(gap):
    """An exponential attraction, and a repulsion of four times its range."""
    pull, push = 2 * np.exp(-2 * gap), 0.25 * np.exp(-gap / 2)
    return push - pull, 2 * pull - push / 2, 2 * push - pull / 2


def in_units(law, length, energy):
    """A law in SI as a law in units of a length and of an energy per area over it."""
    units = energy / length, energy / length**2, energy
    return lambda gap: tuple(value / unit for value, unit in zip(law(gap * length), units))


@functools.cache
def path_by_axis(s, axis, ends, law=lennard_jones, image=None, layer=None, softness=(0.0,)):
    """H0 and loads, (two, states), at each gap on the axis, from large gaps inwards; and, for each
    softness, H0 and load, (two, folds), where H0 - softness*load turns: the position of a drive
    with a spring. softness is in lengths over loads of the result."""
    bodies = HalfSpace(ends, image=image, layer=layer)
    states = bodies.with_axis(law, s, axis)
    folds = [bodies.folds(law, s, axis, states, each) for each in softness]
    loads = [[h0, bodies.load(law, s, gap)] for gap, h0 in states]
    return tuple(np.array(found).T for found in (loads, *folds))
