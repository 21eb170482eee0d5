"""Claims about what the surface of layers on a base yields to waves of pressure, against the
layers' equations solved in sixty digits."""

import math
import subprocess

import numpy as np
import pytest
from support.layered import surface_yield
from support.processes import HANG


@pytest.fixture(scope="module")
def yielding(snapin_path):
    def values(k, thickness, shear, poisson, base=None):
        """L(k) as the program has it; base: shear modulus and Poisson's ratio, or rigid."""
        lines = [str(len(thickness)), *(" ".join(map(repr, row))
                                        for row in (thickness, shear, poisson)),
                 f"F {base[0]!r} {base[1]!r}" if base else "T 1.0 0.0",
                 str(len(k)), " ".join(map(repr, map(float, k)))]
        done = subprocess.run([snapin_path.parent / "layer_waves"], input="\n".join(lines) + "\n",
                              capture_output=True, text=True, check=True, timeout=HANG)
        return np.array(done.stdout.split(), float)

    return values


WAVES = [1e-6, 1e-3, 0.03, 0.4, 0.999, 1.001, 3.0, 12.0]
BODIES = {
    "soft on rigid": ([1.0], [1.0], [0.3], None),
    "incompressible on rigid": ([1.0], [1.0], [0.5], None),
    "soft on stiff": ([1.0], [1e-6], [0.5], (1.0, 0.2)),
    "stiff on soft": ([1.0], [1e6], [0.2], (1.0, 0.5)),
    "auxetic": ([1.0], [4.0], [-0.7], (1.0, -0.9)),
    "thin on thick": ([1e-4, 1.0], [1e3, 1.0], [0.3, 0.49], (1e2, 0.2)),
    "thick on thin": ([1.0, 1e-4], [1.0, 1e-6], [0.5, 0.5], None),
    "mica on glue on silica": ([0.4, 1.0], [40.0, 1.0], [0.25, 0.5], (31.0, 0.17)),
    "five": ([0.3, 0.1, 1.0, 0.01, 0.4], [1.0, 1e6, 1.0, 1e-3, 1e3], [0.5, 0.1, 0.4, 0.5, 0.3],
             (1e-3, 0.45)),
}


@pytest.mark.parametrize("body", BODIES)
def test_waves_move_the_surface_as_the_equations_of_elasticity_say(yielding, body):
    thickness, shear, poisson, base = BODIES[body]
    exact = [surface_yield(k, thickness, shear, poisson, base) for k in WAVES]
    assert yielding(WAVES, thickness, shear, poisson, base) == pytest.approx(exact, rel=1e-12)


def test_limits_of_long_and_short_waves(yielding):
    base, nu = (3.0, 0.1), 0.45
    modulus = 2 * 3.0 / (1 - 0.1), 2 * 1.0 / (1 - nu)
    long, short = yielding([1e-12, 400.0], [1.0], [1.0], [nu], base)
    assert long == pytest.approx(modulus[1] / modulus[0], rel=1e-10)
    assert short == pytest.approx(1, rel=1e-14)
    # Springs side by side, and what is incompressible, on rigid ground.
    springs, = yielding([1e-6], [1.0], [1.0], [0.3])
    assert springs == pytest.approx(1e-6 * (1 - 2 * 0.3) / (2 * (1 - 0.3) ** 2), rel=1e-5)
    volume, = yielding([1e-3], [1.0], [1.0], [0.5])
    assert volume == pytest.approx(2e-9 / 3, rel=1e-5)
    assert yielding([0.7], [1.0], [2.0], [0.3], (2.0, 0.3)) == pytest.approx([1], rel=1e-14)


def test_layers_of_one_material_are_one(yielding):
    base, k = (0.01, 0.3), np.geomspace(0.01, 10, 9)
    one = yielding(k, [1.0], [1.0], [0.4], base)
    assert yielding(k, [0.3, 0.6, 0.1], [1.0] * 3, [0.4] * 3, base) == pytest.approx(one, rel=1e-13)
    assert math.isfinite(yielding([5000.0], [1.0, 1.0], [1.0, 1e6], [0.5, 0.1], base)[0])
