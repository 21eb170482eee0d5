"""Claims about contact_law/snapin_contact.js: it is the law in Python, to rounding."""

import json

import law_calculator
import numpy as np
import pytest
from snapin.contact_law import ContactLaw, coefficients
from support import browser as browsers
from support.browser import browser
from support.contact_header import (
    FOLDER, FUNCTIONS, MUS, NUMBERS, assert_same, bodies_at, gaps_of, parted)

pytestmark = pytest.mark.skipif(
    not (browsers.CHROMIUM and browsers.DRIVER), reason="no Chromium with ChromeDriver")
SCRIPT = (FOLDER / "snapin_contact.js").read_text(encoding="utf-8")
# What is called otherwise there.
NAMES = {"contact_radius": "contactRadius", "pull_off": "pullOff", "pull_off_h0": "pullOffH0",
         "snap_in": "snapIn", "snap_off": "snapOff", "snap_in_load": "snapInLoad",
         "snap_off_load": "snapOffLoad", "energy_lost": "energyLost"}


@pytest.fixture(scope="module")
def window():
    with browser(1280, 900) as opened:
        yield opened


def called(window, bodies, h0=(), before=(), script=SCRIPT):
    """Return the numbers, and the functions and the contact at h0; None where there is no law."""
    functions, numbers = ([NAMES.get(name, name) for name in names]
                          for names in (FUNCTIONS, NUMBERS))
    return window.run(
        script + """
        const [bodies, h0, before, functions, numbers] = JSON.parse(arguments[0]);
        // JSON has no NaN and no infinity.
        const law = snapinContact(...bodies.map(Number));
        return law && [numbers.map(name => String(law[name])),
          ...functions.map(name => h0.map((one, i) => String(law[name](one, before[i])))),
          h0.map((one, i) => law.inContact(one, before[i]))];""",
        json.dumps([[f"{one}".replace("inf", "Infinity") for one in bodies],
                    list(map(float, h0)), list(map(bool, before)), functions, numbers]))


def array(texts):
    return np.array([float(one.replace("Infinity", "inf")) for one in texts])


@pytest.mark.parametrize("mu", MUS)
def test_script_and_python_are_the_same_law(window, mu):
    law = ContactLaw(*bodies_at(mu))
    h0 = gaps_of(law, np.random.default_rng(1))
    before = np.arange(h0.size) % 2 == 1
    numbers, *functions, after = called(window, bodies_at(mu), h0, before)
    assert_same(law, h0, before, map(array, functions), np.array(after), array(numbers))


def test_a_turn_between_two_panels_is_found(window):
    """The slopes of two tiles may differ so that a turn lies in neither: there was no jump."""
    table, mus = parted(coefficients())
    for mu in mus:
        law = ContactLaw(*bodies_at(mu), table=table)
        numbers, *_ = called(window, bodies_at(mu), script=law_calculator.script_text(table))
        for name, found in zip(NUMBERS, array(numbers)):
            assert found == pytest.approx(getattr(law, name), rel=1e-7), name


@pytest.mark.parametrize("bodies", [(0, 1, 1, 1), (1, -1, 1, 1), (1, 1, np.nan, 1),
                                    (1, 1, 1, np.inf), (1e40, 1e-40, 1, 1e-40)])
def test_impossible_bodies_have_no_law(window, bodies):
    assert called(window, bodies) is None
