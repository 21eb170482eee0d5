"""A mesh for two successive Abel transforms, which are the elastic kernel.

Copson's identity says that with g(s) = Int_s^inf P t dt/sqrt(t^2 - s^2)

    Int_0^inf P(t) k(r,t) t dt = (4/pi) Int_0^r g(s) ds/sqrt(r^2 - s^2)

so no elliptic integral is needed. A square root as the variable of integration removes square-root
singularities; the nodes are Gauss-Legendre nodes in panels of z, x = centre + d sinh z.
"""

import functools
import math

import numpy as np
from support.calculus import gauss


@functools.lru_cache(maxsize=None)
def barycentric(count):
    points, weights = gauss(count)
    return (-1.0) ** np.arange(count) * np.sqrt(points * (1 - points) * weights)


def lagrange(u, count):
    """Values at u of the polynomials that are 1 at one Gauss point; the last axis counts them."""
    distance = u[..., None] - gauss(count)[0]
    distance[distance == 0] = 1e-300
    terms = barycentric(count) / distance
    return terms / terms.sum(-1, keepdims=True)


class Mesh:
    """Nodes x = centre + d sinh z, and the elastic operator on them.

    `operator` @ P is Int P k t dt at the nodes; `axis` and `edge` are its rows for x = 0 and x = 1;
    `area` @ P is Int P t dt. All for unit scale: with r = c x they are multiplied by c and c^2.
    """

    def __init__(self, centre, d, reach, resolution, finer=1):
        self.centre, self.d, self.order = centre, d, resolution.order
        self.ends = self.panels(reach, resolution.width, finer)
        points, weights = gauss(self.order)
        width = np.diff(self.ends)[:, None]
        self.z = (self.ends[:-1, None] + width * points).ravel()
        self.x, self.stretch = self.position(self.z), self.growth(self.z)
        self.weights = (width * weights).ravel()
        self.area = self.weights * self.x * self.stretch
        inner = self.inner_transform()
        outer = self.outer_transform(self.z)
        self.operator = (4 / math.pi) * outer @ inner
        axis = np.zeros((1, len(self.z)))
        axis[0, : self.order] = (math.pi / 2) * lagrange(np.zeros(1), self.order)[0]
        self.axis = ((4 / math.pi) * axis @ inner)[0]
        if centre:
            self.edge = ((4 / math.pi) * self.outer_transform(np.zeros(1)) @ inner)[0]

    def panels(self, reach, width, finer):
        """Ends of the panels in z; up to x = 4 they are `finer` times as narrow."""
        places = (0.0, 4.0, reach) if finer > 1 else (0.0, reach)
        low, *ends = (math.asinh((x - self.centre) / self.d) for x in places)
        all_ends = [np.array([low])]
        for high in ends:
            count = math.ceil((high - low) / width * (finer if high < ends[-1] else 1))
            all_ends.append(np.linspace(low, high, count + 1)[1:])
            low = high
        return np.concatenate(all_ends)

    def position(self, z):
        """x at z; near x = 0 of a mesh in contact computed without cancellation."""
        if not self.centre:
            return self.d * np.sinh(z)
        low = math.asinh(-1 / self.d)
        return 2 * self.d * np.cosh((z + low) / 2) * np.sinh((z - low) / 2)

    def growth(self, z):
        """dx/dz."""
        return self.d * np.cosh(z)

    def panel(self, k):
        """Ends of panel k and the columns of its nodes."""
        return self.ends[k], self.ends[k + 1], slice(k * self.order, (k + 1) * self.order)

    def basis(self, k, z):
        """The polynomials of panel k at z."""
        return lagrange((z - self.ends[k]) / (self.ends[k + 1] - self.ends[k]), self.order)

    def inner_transform(self):
        """Matrix of g(s) = Int_s^inf P t dt/sqrt(t^2 - s^2), at the nodes."""
        matrix = np.zeros((len(self.z), len(self.z)))
        for k in range(len(self.ends) - 1):
            a, b, columns = self.panel(k)
            near = (self.z < b) & (self.z > 2 * a - b)
            far = self.z <= 2 * a - b
            x = self.x[columns]
            matrix[far, columns] = self.area[columns] / np.sqrt(x**2 - self.x[far, None] ** 2)
            if k == 0:
                for i in np.flatnonzero(near):
                    matrix[i, columns] = self.beside_the_axis(i)
            else:
                start = np.maximum(a, self.z[near])
                matrix[near, columns] = self.pull(k, self.z[near], start, np.full(len(start), b))
        return matrix

    def pull(self, k, target, start, end):
        """Int P t dt/sqrt(t^2 - s^2) over [start, end] of panel k, by y = sqrt(z - z_s)."""
        low, high = np.sqrt(start - target), np.sqrt(end - target)
        points, weights = gauss(32)
        y = low[:, None] + (high - low)[:, None] * points
        z = target[:, None] + y**2
        t, s = self.position(z), self.position(target)[:, None]
        difference = 2 * self.d * np.cosh((z + target[:, None]) / 2) * np.sinh(y**2 / 2)
        kernel = t * self.growth(z) * 2 * y / np.sqrt(difference * (t + s))
        return np.einsum("iq,iqj->ij", kernel * weights * (high - low)[:, None], self.basis(k, z))

    def beside_the_axis(self, i):
        """The same in the first panel, where t = -s is also close: pieces of doubled length."""
        a, b, _ = self.panel(0)
        cuts = [self.z[i]]
        while cuts[-1] < b:
            cuts.append(min(b, a + 2 * (cuts[-1] - a)))
        cuts = np.array(cuts)
        target = np.full(len(cuts) - 1, self.z[i])
        return self.pull(0, target, cuts[:-1], cuts[1:]).sum(0)

    def outer_transform(self, targets):
        """Matrix of Int_0^r g ds/sqrt(r^2 - s^2) at the places z = targets."""
        matrix = np.zeros((len(targets), len(self.z)))
        place = self.position(targets)
        for k in range(len(self.ends) - 1):
            a, b, columns = self.panel(k)
            near = (targets > a) & (targets < 2 * b - a)
            far = targets >= 2 * b - a
            x = self.x[columns]
            matrix[far, columns] = (self.weights * self.stretch)[columns] / np.sqrt(
                place[far, None] ** 2 - x**2)
            if k == 0:
                inside = near & (targets <= b)
                matrix[inside, columns] = self.around_the_axis(place[inside])
                near &= ~inside
            matrix[near, columns] = self.push(k, targets[near])
        return matrix

    def push(self, k, target):
        """Int g ds/sqrt(r^2 - s^2) over panel k below r, by y = sqrt(z_r - z)."""
        a, b, _ = self.panel(k)
        low, high = np.sqrt(target - np.minimum(b, target)), np.sqrt(target - a)
        points, weights = gauss(32)
        y = low[:, None] + (high - low)[:, None] * points
        z = target[:, None] - y**2
        s, r = self.position(z), self.position(target)[:, None]
        difference = 2 * self.d * np.cosh((z + target[:, None]) / 2) * np.sinh(y**2 / 2)
        kernel = self.growth(z) * 2 * y / np.sqrt(difference * (r + s))
        return np.einsum("iq,iqj->ij", kernel * weights * (high - low)[:, None], self.basis(k, z))

    def around_the_axis(self, r):
        """The same by s = r sin(angle), for targets in the first panel."""
        points, weights = gauss(32)
        s = r[:, None] * np.sin(math.pi / 2 * points)
        z = np.arcsinh((s - self.centre) / self.d)
        return np.einsum("q,iqj->ij", math.pi / 2 * weights, self.basis(0, z))

    def interpolate(self, values, x):
        """A function given at the nodes, at places x inside the mesh."""
        return self.interpolation(np.arcsinh((x - self.centre) / self.d)) @ values

    def interpolation(self, z):
        """The matrix from values at the nodes to values at the places z."""
        panel = np.clip(np.searchsorted(self.ends, z) - 1, 0, len(self.ends) - 2)
        matrix = np.zeros((len(z), len(self.z)))
        for k in set(panel):
            here = panel == k
            matrix[here, self.panel(k)[2]] = self.basis(k, z[here])
        return matrix
