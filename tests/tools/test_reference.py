"""The independent reference is worth its name: closed forms, two resolutions, known numbers.

It is part of the tests, not of the program; studies and tests hold the program against it.
"""

import math

import numpy as np
import pytest
from support.abel import Mesh
from support.calculus import gauss
from support.known import BY_SIGMA
from support.reference import CUSP, Path, path
from support.scenes import JKR
from support.series import FINE


@pytest.mark.parametrize("centre, d, finer", [(0.0, 0.3, 2), (1.0, 0.05, 1), (1.0, 0.2, 2)])
def test_two_abel_transforms_are_the_elastic_kernel(centre, d, finer):
    """Under (1 + t^2)^(-3/2) the surface sinks by 2/sqrt(1 + r^2)."""
    # As fast as that falls, a mesh that ends lacks about 1/end^2.
    mesh = Mesh(centre, d, 1e6, FINE, finer)
    p = (1 + mesh.x**2) ** -1.5
    np.testing.assert_allclose(mesh.operator @ p, 2 / np.sqrt(1 + mesh.x**2), atol=1e-10)
    assert mesh.axis @ p == pytest.approx(2, abs=1e-10)
    assert mesh.area @ p == pytest.approx(1, abs=2e-6)
    if centre:
        assert mesh.edge @ p == pytest.approx(math.sqrt(2), abs=1e-10)


def test_hertz_pressure_flattens_a_parabola():
    """sqrt(1 - t^2) has a deformation of (pi/4)(2 - r^2) inside, wherever its edge is."""
    mesh = Mesh(1.0, 1e-4, 50.0, FINE)
    p = np.sqrt(np.maximum(1 - mesh.x**2, 0))
    inside = mesh.x < 1
    exact = (math.pi / 4) * (2 - mesh.x[inside] ** 2)
    np.testing.assert_allclose((mesh.operator @ p)[inside], exact, atol=1e-5)


@pytest.mark.parametrize("sigma", BY_SIGMA)
def test_what_another_solution_found_is_found_to_its_last_digit(sigma):
    # A unit of the last digit, the other solution's own uncertainty.
    near = {"abs": 1e-7}
    tension, h0, in_h0, in_load, out_h0, out_load = BY_SIGMA[sigma]
    found = path(sigma)
    assert found.pull_off.load == pytest.approx(-tension * JKR, abs=1e-8 * JKR)
    assert found.pull_off.h0 == pytest.approx(h0, **near)
    assert found.jump_in.h0 == pytest.approx(in_h0, **near)
    assert found.jump_in.load == pytest.approx(in_load, **near)
    assert found.jump_out.h0 == pytest.approx(out_h0, **near)
    assert found.jump_out.load == pytest.approx(out_load, **near)


def numbers(found):
    """The results of a path, those that there are."""
    end = found.on(found.contact_branch, found.h0_end)
    points = [found.pull_off, found.jump_in, found.jump_out, end]
    return np.array([value for point in points if point for value in (point.h0, point.load)]
                    + [found.energy_lost or 0.0])


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [1e-3, 0.35, 30.0])
def test_two_resolutions_agree_to_nine_digits(sigma):
    usual, fine = map(numbers, (path(sigma), Path(sigma, resolution=FINE)))
    np.testing.assert_allclose(usual, fine, rtol=1e-9)


def test_the_cusp_is_where_it_is_known_to_be():
    assert not path(CUSP - 1e-7).folds
    assert len(path(CUSP + 1e-7).folds) == 2


def test_energy_lost_is_the_work_of_the_loop():
    """The area between two branches, by states on them, one by one."""
    found = path(0.87)
    low, high = found.jump_in.h0, found.jump_out.h0
    # Both branches end in a square root: h0 = low + ... sin^2 takes it away.
    angle, weights = gauss(40, 0, math.pi / 2)
    h0 = low + (high - low) * np.sin(angle) ** 2
    rate = (high - low) * np.sin(2 * angle)
    pairs = [(found.on(found.far_branch, x), found.on(found.contact_branch, x)) for x in h0]
    loads = np.array([one.load - other.load for one, other in pairs])
    assert weights @ (rate * loads) == pytest.approx(found.energy_lost, rel=1e-8)


@pytest.mark.slow
def test_branches_between_the_jumps_are_unstable_however_many_folds():
    found = path(1000.0)
    assert len(found.folds) == 8
    unstable = [branch.unstable for branch in found.branches]
    assert unstable == [0, 1, 2, 3, 4, 3, 2, 1, 0]
