"""Claims about meshes mapped by sinh to the edge or the axis, with a tail to infinity."""

from dataclasses import dataclass, field

import _snapin
import numpy as np
import pytest
import snapin
from support.calculus import gauss, graded_rule
from support.half_space import kernel
from test_discretisation import gaussian, graded

flat = _snapin.flat_numerics
DIGITS = 14.0


@dataclass
class Mapped:
    """A mesh of src/mesh/mapped_mesh.f90: sinh panels by order and length in z, then a tail; the
    first may be a power panel."""

    centre: float
    d: float
    order: list
    z_length: list
    tail: int = 0
    decay: float = 6.0
    digits: float = DIGITS
    power: int = 1
    focus: float = 0.0
    x: np.ndarray = field(init=False)
    weight: np.ndarray = field(init=False)

    def __post_init__(self):
        self.x, self.weight, _ = flat.mesh_nodes(*self.shape, self.size)

    @property
    def size(self):
        return sum(self.order) + self.tail

    @property
    def shape(self):
        numbers = self.d, self.decay, self.digits, self.power, self.focus
        return "mapped", self.centre, self.z_length, [*self.order, self.tail], numbers

    def matrix(self):
        return flat.mesh_matrix(*self.shape, self.size)

    def columns(self):
        """Return the matrix for pressures in units of what the tail leaves of them."""
        begin = self.x[-self.tail - 1]
        left = np.where(np.arange(self.size) < self.size - self.tail, 1.0, self.x / begin)
        return self.matrix() * left**-self.decay

    def interpolate(self, values, at):
        return flat.mesh_interpolation(*self.shape, values, np.atleast_1d(at))


def contact_mesh(d, reach, order, tail, decay, digits=DIGITS):
    """Return a mesh about the edge at 1: one panel inside, one out to the offset `reach`."""
    inside = np.arcsinh(1 / d)
    return Mapped(1.0, 1 / np.sinh(inside), [order, order], [inside, np.arcsinh(reach / d)],
                  tail, decay, digits)


def approach_mesh(d, reach, order, tail, decay):
    return Mapped(0.0, d, [order, order], [np.arcsinh(reach / d) / 2] * 2, tail, decay)


# Pressures with a power tail whose deformation is known: the Hankel transform of
# (1 + t^2)^(-3/2) is exp(-k), of (1 + t^2)^(-5/2) it is (1 + k) exp(-k)/3.
TAILS = {
    3: (lambda t: (1 + t**2) ** -1.5, lambda r: 2 / np.sqrt(1 + r**2), 1.0),
    5: (
        lambda t: (1 + t**2) ** -2.5, lambda r: 2 / 3 * ((1 + r**2) ** -0.5 + (1 + r**2) ** -1.5),
        1 / 3),
}


@pytest.mark.parametrize("decay", TAILS)
@pytest.mark.parametrize("mesh", ["contact", "small contact", "approach"])
def test_a_power_tail_is_integrated_to_infinity(decay, mesh):
    pressure, deformation, load = TAILS[decay]
    grid = {
        "contact": lambda: contact_mesh(0.05, 3.0, 32, 14, decay),
        "small contact": lambda: contact_mesh(0.3, 3.0, 32, 14, decay),
        "approach": lambda: approach_mesh(0.3, 3.0, 24, 14, decay)}[mesh]()
    p = pressure(grid.x)
    at = np.concatenate([[0.0, grid.centre], grid.x])
    # Of the smallest pressures rounding leaves less, and they count for less.
    np.testing.assert_allclose(grid.matrix() @ p, deformation(at), rtol=3e-11)
    assert grid.weight @ p == pytest.approx(load, rel=3e-11)


def test_without_a_tail_the_mesh_ends():
    grid = contact_mesh(0.1, 6.0, 56, 0, 0.0)
    assert grid.x.max() < 7.0
    p = np.exp(-(grid.x**2))
    np.testing.assert_allclose(grid.matrix()[2:] @ p, gaussian(grid.x, 1.0), rtol=1e-12)
    assert grid.weight @ p == pytest.approx(0.5, rel=1e-13)


@pytest.mark.parametrize("neck", [1e-1, 1e-3, 1e-5])
def test_a_sharp_edge_has_the_deformation_that_graded_panels_find(neck):
    def pressure(x):
        """A Lorentzian neck of this width at the edge, on a smooth ground, with a tail x^-4."""
        return (1 / (1 + ((x**2 - 1) / neck) ** 2) + 0.1) / (1 + x**2) ** 2

    # Nodes in proportion to the length in z.
    order = 30 + int(7 * np.arcsinh(4 / neck))
    grid = contact_mesh(0.5 * neck, 4.0, order, 24, 4.0)
    fine = snapin.panel_mesh(graded(1.0, 3e4, 0.1 * neck), 16, centre=1.0)
    matrix = fine.matrix()
    raised = grid.matrix() @ pressure(grid.x)
    exact = matrix.nodes @ pressure(fine.x)
    there = fine.interpolate(exact, grid.x[grid.x < 100])
    np.testing.assert_allclose(raised[2:][grid.x < 100], there, rtol=2e-9)
    assert raised[0] == pytest.approx(matrix.axis @ pressure(fine.x), rel=1e-9)
    assert raised[1] == pytest.approx(matrix.centre @ pressure(fine.x), rel=1e-9)


def panel_reference(grid, row, panel, degree):
    """Return the deformation by a Legendre polynomial on one panel, its tail included, by a graded
    rule from the maps as the module states them."""
    edges = np.concatenate([[-grid.z_length[0] if grid.centre + grid.focus else 0], grid.z_length])
    edges = np.cumsum(edges)
    orders = [*grid.order, grid.tail]
    middle = grid.centre + grid.focus

    def mapped(z):
        return middle + grid.d * np.sinh(z)

    def place(s):
        """Position, its rate of change, and what the tail leaves of pressures."""
        if panel == 0 and grid.power > 1:
            end = mapped(edges[1])
            return end * s**grid.power, end * grid.power * s ** (grid.power - 1), 1
        if panel < len(grid.order):
            z, length = edges[panel] + grid.z_length[panel] * s, grid.z_length[panel]
            return mapped(z), grid.d * length * np.cosh(z), 1
        begin = mapped(edges[-1])
        return begin / (1 - s), begin / (1 - s) ** 2, (1 - s) ** grid.decay

    r = [0.0, grid.centre, *grid.x][row]
    own = row - 2 - sum(orders[:panel])
    cuts = [0.0, 1.0]
    if 0 <= own < orders[panel]:
        cuts.insert(1, gauss(orders[panel])[0][own])
        r = place(cuts[1])[0]
    total = 0.0
    # Towards every end, where the logarithm is or is near.
    points, weights = graded_rule(1e-10)
    for a, b in zip(cuts, cuts[1:]):
        half = (b - a) / 2
        for s in a + half * points, b - half * points:
            t, speed, tail = place(s)
            polynomial = np.polynomial.legendre.Legendre.basis(degree)(2 * s - 1)
            felt = kernel(r, t, np.maximum(abs(r - t), 1e-17))
            total += half * weights @ (felt * polynomial * tail * t * speed)
    return total


def panel_deformation(grid, panel, degree):
    """Return what the matrix makes of the same pressure."""
    orders = [*grid.order, grid.tail]
    s, _ = gauss(orders[panel])
    p = np.polynomial.legendre.Legendre.basis(degree)(2 * s - 1)
    if panel == len(grid.order):
        p *= (1 - s) ** grid.decay
    first = sum(orders[:panel])
    return grid.matrix()[:, first:first + len(s)] @ p


# Between them: panels about an edge, at the axis and apart from it, shorter and longer than the
# axis is felt, and panels whose neighbour ends nearer to the axis than they are long.
PANELS = {
    "contact": lambda: Mapped(1.0, 1 / np.sinh(5.0), [26, 34], [5.0, 6.2], 5),
    "small contact": lambda: Mapped(1.0, 1 / np.sinh(1.6), [20, 34], [1.6, 5.0], 5),
    "short panels": lambda: Mapped(1.0, 1 / np.sinh(0.7), [14] * 4, [0.7] * 4, 5),
    "approach": lambda: Mapped(0.0, 0.2, [30], [4.0], 6, 18.0),
    "about a place": lambda: Mapped(0.0, 0.3, [20, 12, 24], [3.1, 0.8, 2.4], 5,
                                    focus=0.3 * np.sinh(3.1)),
    "near the axis": lambda: Mapped(0.0, 0.5, [24, 26], [0.6, 3.0], 5,
                                    focus=0.5 * np.sinh(0.6)),
    "towards a tip": lambda: Mapped(0.0, 0.5, [14] * 3, [0.3, 0.4, 0.8], 4, 18.0, power=2),
    "tip in contact": lambda: Mapped(1.0, 1 / np.sinh(3.0), [16, 20, 26], [0.3, 2.7, 4.0], 5,
                                     power=4),
}


@pytest.mark.parametrize("mesh", PANELS)
def test_deformation_is_that_of_graded_quadrature(mesh):
    grid = PANELS[mesh]()
    orders = [*grid.order, grid.tail]
    first = np.concatenate([[0], np.cumsum(orders)])
    for panel, order in enumerate(orders):
        degree = 3 * (panel % 2)
        found = panel_deformation(grid, panel, degree)
        near = [2 + min(k, grid.size - 1) for k in (first[panel], first[panel + 1])]
        for row in {0, 1, 3, grid.size + 1, 2 + first[panel] + order // 2, *near}:
            exact = panel_reference(grid, row, panel, degree)
            # The tail's last polynomial is large where its factor is nearly gone: rounding,
            # another on other processors, leaves up to 5e-11 of its integral.
            missed = abs(found[row] - exact) / np.abs(found).max()
            assert missed < 2e-10, (row, panel, degree)


@pytest.mark.parametrize("digits", [4.0, 7.0, 10.0])
def test_the_kernel_has_the_digits_that_are_asked_for(digits):
    exact = contact_mesh(1e-4, 4.0, 40, 8, 6.0).columns()
    rough = contact_mesh(1e-4, 4.0, 40, 8, 6.0, digits).columns()
    assert np.abs((rough - exact) / np.abs(exact).max(1)[:, None]).max() < 10.0**-digits


def test_on_a_power_panel_a_logarithm_converges_with_twice_the_power():
    # ln(r) on a disc of radius 1 raises the axis by 2 Int ln(r) dr = -2.
    def missed(order):
        mesh = Mapped(0.0, 0.5, [order, 24], [0.4, np.arcsinh(2.0) - 0.4], power=3)
        assert mesh.weight @ np.log(mesh.x) == pytest.approx(-0.25, abs=1e-8)
        return abs(mesh.matrix()[0] @ np.log(mesh.x) + 2)

    assert missed(20) < missed(10) / 2**5.5 < 3e-8


def test_what_is_bounded_is_interpolated_out_to_infinity():
    grid = contact_mesh(0.1, 3.0, 28, 12, 6.0)
    at = np.array([0.0, 0.3, 1.0, 1.02, 3.9, 4.1, 50.0, 1e6])
    found = grid.interpolate(1 / np.sqrt(1 + grid.x**2), at)
    np.testing.assert_allclose(found, 1 / np.sqrt(1 + at**2), atol=1e-9)
