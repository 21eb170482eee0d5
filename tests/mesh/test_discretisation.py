"""Claims about meshes: closed forms, orders of convergence, load weights."""

import math

import mpmath
import numpy as np
import pytest
import snapin

LINEAR = np.array([0.0, 1.0])


def local_nodes(order):
    """Return the nodes on [0, 1] of a panel: its ends for order 2, else Gauss points."""
    return LINEAR if order == 2 else snapin.gauss_rule(order).x


def elliptic(m):
    """K and E of parameter m below 1."""
    return [np.vectorize(one, otypes=[float])(m) for one in (mpmath.ellipk, mpmath.ellipe)]


# --- Closed forms of the integral of k(r, t) p(t) t dt. With the kernel of the half-space it is the
# deformation -u E/(1-nu^2) of a pressure p.


def disc(r, radius=1.0):
    """p = 1 up to `radius`."""
    x = np.asarray(r) / radius
    inner = 4 / np.pi * elliptic(np.minimum(x, 1) ** 2 * (x < 1))[1]
    m = np.where(x > 1, 1 / np.maximum(x, 1) ** 2, 0.0)
    k, e = elliptic(m)
    outer = 4 / np.pi * x * (e - (1 - m) * k)
    return radius * np.where(x < 1, inner, np.where(x > 1, outer, 4 / np.pi))


def hertz(r):
    """p = sqrt(1 - t^2) up to 1."""
    x = np.maximum(r, 1)
    outer = ((2 - x**2) * np.arcsin(1 / x) + np.sqrt(x**2 - 1)) / 2
    return np.where(r < 1, np.pi / 4 * (2 - np.asarray(r) ** 2), outer)


def punch(r):
    """p = 1/sqrt(1 - t^2) up to 1."""
    return np.where(r < 1, np.pi, 2 * np.arcsin(1 / np.maximum(r, 1)))


def gaussian(r, a):
    """p = exp(-a t^2)."""
    bessel = [float(mpmath.exp(-z) * mpmath.besseli(0, z)) for z in a * np.square(r) / 2]
    return math.sqrt(math.pi / a) * np.array(bessel)


def graded(centre, extent, finest, growth=2.0):
    """Return panel ends about `centre`, of sizes that grow by `growth` away from it."""
    sizes = finest * growth ** np.arange(200)
    ends = np.concatenate([[0.0], np.cumsum(sizes)])
    outward = np.append(ends[ends < extent - centre], extent - centre)
    if centre == 0:
        return outward
    inward = np.append(ends[ends < centre], centre)
    return np.concatenate([-inward[:0:-1], outward])


def orders(errors):
    """Return the orders of convergence of errors at steps halved each time."""
    return np.log2(np.divide(errors[:-1], errors[1:]))


# --- Closed forms on whole meshes

CONTACT_MESHES = {
    "graded to the edge": {"ends": graded(1.0, 4.0, 0.05), "centre": 1.0},
    "even": {"ends": np.linspace(0, 4, 9)}}


@pytest.mark.parametrize("name", CONTACT_MESHES)
def test_disc_and_ring_of_constant_pressure_are_exact(name):
    mesh = snapin.panel_mesh(order=8, **CONTACT_MESHES[name])
    matrix = mesh.matrix()
    inside, ring = mesh.x < 1, (mesh.x > 1) & (mesh.x < 2)
    outer = mesh.ends + mesh.centre
    assert 1 in outer and (2 in outer or mesh.centre)
    np.testing.assert_allclose(matrix.nodes @ inside, disc(mesh.x), rtol=1e-13)
    assert matrix.axis @ inside == pytest.approx(2, rel=1e-14)
    if not mesh.centre:
        exact = disc(mesh.x, 2.0) - disc(mesh.x)
        np.testing.assert_allclose(matrix.nodes @ ring, exact, rtol=1e-12)
        np.testing.assert_array_equal(matrix.centre, matrix.axis)
    else:
        assert matrix.centre @ inside == pytest.approx(4 / math.pi, rel=1e-14)


def test_uniform_mesh_is_exact_for_a_constant_pressure():
    mesh = snapin.uniform_mesh(41, 1.0)
    np.testing.assert_allclose(mesh.matrix().nodes.sum(1), disc(mesh.x), rtol=1e-13)


def test_gaussian_pressure():
    a = 3.0
    mesh = snapin.panel_mesh(np.arange(0, 4.3, 0.25), 12)
    found = mesh.matrix().nodes @ np.exp(-a * mesh.x**2)
    # Beyond the mesh the pressure is below exp(-50).
    np.testing.assert_allclose(found, gaussian(mesh.x, a), rtol=1e-13)


def edge_graded(order, finest):
    """Return a mesh fit for a singularity at the edge, and 1 - x^2 at its nodes (0 outside)."""
    ends = np.concatenate([graded(1.0, 1.0, finest)[:-1], [0.0, 0.5, 2.0]])
    # Distances from the edge, which the positions themselves round off.
    offset = ends[:-1, None] + np.diff(ends)[:, None] * local_nodes(order)
    mesh = snapin.panel_mesh(ends, order, centre=1.0)
    return mesh, np.where(offset < 0, -offset * (2 + offset), 0).ravel()


def test_hertz_pressure_makes_a_parabola_inside_and_the_known_gap_outside():
    # What the finest panel can miss is (1e-9)^(3/2).
    mesh, square = edge_graded(12, 1e-9)
    pressure = np.sqrt(square)
    matrix = mesh.matrix()
    np.testing.assert_allclose(matrix.nodes @ pressure, hertz(mesh.x), rtol=1e-13)
    assert matrix.axis @ pressure == pytest.approx(math.pi / 2, rel=1e-13)
    assert matrix.centre @ pressure == pytest.approx(math.pi / 4, rel=1e-13)
    assert mesh.weight @ pressure == pytest.approx(1 / 3, rel=1e-13)


def test_flat_punch_pressure_makes_a_plane():
    # The pressure grows as distance^(-1/2): the finest panel may miss 1e-13, which at the edge
    # itself the logarithm of 1e-26 raises to a few times that.
    mesh, square = edge_graded(16, 1e-26)
    pressure = np.where(square > 0, np.maximum(square, 1e-300) ** -0.5, 0)
    matrix = mesh.matrix()
    np.testing.assert_allclose(matrix.nodes @ pressure, punch(mesh.x), rtol=1e-12)
    assert matrix.axis @ pressure == pytest.approx(math.pi, rel=1e-13)
    assert matrix.centre @ pressure == pytest.approx(math.pi, rel=1e-12)
    assert mesh.weight @ pressure == pytest.approx(1, rel=1e-13)


# --- Orders of convergence


def test_uniform_mesh_is_of_second_order_for_a_smooth_pressure():
    errors = []
    for nodes in (51, 101, 201, 401):
        mesh = snapin.uniform_mesh(nodes, 2.5)
        found = mesh.matrix().nodes @ np.exp(-6 * mesh.x**2)
        errors.append(abs(found - gaussian(mesh.x, 6)).max())
    assert (abs(orders(errors) - 2) < 0.1).all()


def test_uniform_mesh_is_of_order_three_halves_for_the_hertz_pressure():
    # At the edge the pressure is (2 d)^(1/2), and a straight line over the last cell misses an area
    # of order h^(1/2) h; at the edge itself that is seen through the kernel's logarithm.
    axis, load, largest = [], [], []
    for nodes in (81, 161, 321, 641):
        mesh = snapin.uniform_mesh(nodes, 2.0)
        pressure = np.sqrt(np.maximum(1 - mesh.x**2, 0))
        matrix = mesh.matrix()
        axis.append(abs(matrix.axis @ pressure - math.pi / 2))
        load.append(abs(mesh.weight @ pressure - 1 / 3))
        largest.append(abs(matrix.nodes @ pressure - hertz(mesh.x)).max())
    assert (abs(orders(axis) - 1.5) < 0.05).all() and (abs(orders(load) - 1.5) < 0.05).all()
    assert (orders(largest) > 1.25).all() and (orders(largest) < 1.5).all()


def test_panels_converge_spectrally_in_their_order():
    errors = {}
    for order in range(4, 17, 2):
        mesh = snapin.panel_mesh(np.arange(0, 4.1, 0.5), order)
        found = mesh.matrix().nodes @ np.exp(-3 * mesh.x**2)
        errors[order] = abs(found - gaussian(mesh.x, 3)).max()
    # Two more nodes a panel gain well over a digit each time, until rounding is reached at 14: what
    # is left there is another on other processors.
    steps = [errors[n] / errors[n + 2] for n in range(4, 12, 2)]
    assert min(steps) > 50
    assert max(errors[14], errors[16]) < 1e-14


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_panels_converge_in_their_size_at_one_more_than_their_order(order):
    # Interpolation is of order `order`; its error at Gauss points is orthogonal to constants, and
    # the kernel, an integral, gains one order from that.
    errors = []
    for panels in (16, 32, 64):
        mesh = snapin.panel_mesh(np.linspace(0, 4, panels + 1), order)
        found = mesh.matrix().nodes @ np.exp(-3 * mesh.x**2)
        errors.append(abs(found - gaussian(mesh.x, 3)).max())
    assert orders(errors)[-1] == pytest.approx(order + 1, abs=0.2)


# --- Invariances


@pytest.mark.parametrize("scale", [8.0, 3.7, 1e-7])
def test_kernel_matrix_is_homogeneous_of_degree_one(scale):
    ends = graded(1.0, 5.0, 0.01)
    small, large = (snapin.panel_mesh(s * ends, 10, centre=s).matrix() for s in (1.0, scale))
    for a, b in zip(small, large):
        np.testing.assert_allclose(b, scale * a, rtol=1e-11, atol=1e-14 * scale * abs(a).max())


def test_leading_part_of_a_matrix_is_that_of_a_leading_part_of_the_mesh():
    ends = np.array([0.0, 0.5, 1.0, 2.0, 4.0])
    whole, part = snapin.panel_mesh(ends, 8), snapin.panel_mesh(ends[:4], 8)
    n = part.x.size
    np.testing.assert_array_equal(whole.matrix().nodes[:n, :n], part.matrix().nodes)
    np.testing.assert_array_equal(whole.weight[:n], part.weight)


# --- Load weights and interpolation


@pytest.mark.parametrize("order", [3, 8, 12, 24])
def test_load_weights_of_panels_are_exact_for_polynomials(order):
    mesh = snapin.panel_mesh([-1.0, -0.7, 0.0, 0.4, 1.5], order, centre=1.0)
    for degree in range(2 * order - 1):
        exact = 2.5 ** (degree + 2) / (degree + 2)
        assert mesh.weight @ mesh.x**degree == pytest.approx(exact, rel=1e-13)


def test_load_weights_of_the_uniform_mesh_are_exact_for_a_linear_pressure():
    mesh = snapin.uniform_mesh(11, 2.5)
    assert mesh.weight.sum() == pytest.approx(2.5**2 / 2, rel=1e-15)
    assert mesh.weight @ mesh.x == pytest.approx(2.5**3 / 3, rel=1e-15)
    assert mesh.spacing == pytest.approx(0.25)


@pytest.mark.parametrize("order", [3, 8, 16])
def test_interpolation_repeats_polynomials_and_nodal_values(order):
    mesh = snapin.panel_mesh([-1.0, -0.7, 0.0, 0.4, 1.5], order, centre=1.0)
    at = np.linspace(0, 2.5, 83)
    for degree in (0, 1, order - 1):
        values = (mesh.x / 2.5) ** degree
        np.testing.assert_allclose(mesh.interpolate(values, at), (at / 2.5) ** degree, atol=1e-12)
        np.testing.assert_allclose(mesh.interpolate(values, mesh.x), values, atol=1e-14)


def test_interpolation_on_the_uniform_mesh_is_linear():
    mesh = snapin.uniform_mesh(6, 1.0)
    values = np.random.default_rng(3).random(6)
    at = np.linspace(0, 1, 57)
    np.testing.assert_allclose(
        mesh.interpolate(values, at), np.interp(at, mesh.x, values), atol=1e-15)
