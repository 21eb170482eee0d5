"""Claims about drives in time that are killed and continued."""

import random

import pytest
from support.interrupted import Bench, frames
from support.scenes import lennard_jones

CREEP = {"compliance": [2.0, 1.0], "retardation_time": [1.0, 0.1]}
DRIVE = {"velocity": 8.0, "z_start": 15.0, "z_turn": -1.0, "dwell": 0.3}


def driven(sigma=0.1, drive=(), **groups):
    return lennard_jones(sigma, drive={**DRIVE, **dict(drive)}, numerics={"accuracy": 1e-2},
                         **groups)


DRIVES = {
    "bodies that remember": driven(viscoelastic=CREEP,
                                   sensitivity={"parameters": "drive.velocity"}),
    "behind a spring": driven(viscoelastic=CREEP, drive={"stiffness": 0.5, "z_start": 40.0}),
    "a fluid": driven(viscoelastic=CREEP, fluid={"viscosity": 0.01}),
    "a fluid alone": driven(fluid={"viscosity": 0.01}),
    "layers": driven(1.0, layer={"young": 4.0, "poisson": 0.3, "thickness": 3.0, "base": "rigid"},
                     fluid={"viscosity": 0.01}),
}


@pytest.fixture(scope="module", params=DRIVES)
def drive(request, snapin, snapin_path, tmp_path_factory):
    return Bench(snapin, snapin_path, tmp_path_factory.mktemp("drive"), DRIVES[request.param])


def test_a_drive_goes_on_from_anywhere(drive):
    parts = frames(drive.journal)
    assert len(parts) > 4
    rng = random.Random(3)
    for count in rng.sample(range(1, len(parts)), 3) + [len(parts)]:
        drive.check(b"".join(parts[:count]))


def test_a_killed_drive_goes_on_again_and_again(drive):
    drive.check_killed(3, 0.03, 0.3)
