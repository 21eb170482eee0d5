"""Claims about docs/calculator.html, in a browser: its numbers are the program's, the address keeps
its values, and it can be used by keyboard and on a telephone."""

import json
import re

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support import browser as browsers
from support.browser import TAB, browser

PAGE = ROOT / "docs" / "calculator.html"
ADDRESS = PAGE.as_uri()
needs_browser = pytest.mark.skipif(
    not (browsers.CHROMIUM and browsers.DRIVER), reason="no Chromium with ChromeDriver")
UNITS = {"a": 1e-18, "f": 1e-15, "p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1, "k": 1e3,
         "M": 1e6, "G": 1e9}


@pytest.fixture(scope="module")
def window():
    with browser(1280, 900) as opened:
        yield opened


@pytest.fixture(scope="module")
def telephone():
    with browser(390, 844) as opened:
        yield opened


def shown(text):
    """The number [SI] that begins a text such as −1.2 µN."""
    found = re.match(r"([−\d.e]+) (\D?)(?:N|m|Pa|J)\b", text)
    return float(found[1].replace("−", "-"))*UNITS[found[2]]


def text_of(window, element):
    return window.run(f"return document.getElementById('{element}').innerText")


def test_the_page_needs_nothing_but_itself():
    text = PAGE.read_text(encoding="utf-8")
    foreign = r"""(?:src|href)=["'](?!data:)|@import|fetch\(|XMLHttpRequest|url\((?!#)"""
    assert not re.search(foreign, text)
    assert PAGE.stat().st_size < 200_000


@needs_browser
@pytest.mark.parametrize("values, deck", [
    ("", {"bodies": {"radius": 5e-6, "young": [3e9, 70e9], "poisson": [0.35, 0.2]},
          "force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.3e-9},
          "device": {"stiffness": 40.0}, "fixed_load": {"load": 2e-7}}),
    ("#r1=20&r2=20&e1=1&e1_unit=GPa&e2=1&n2=0.35&kind=a&a=20&z0=0.2&k=300&k_unit=mN/m&f=-20"
     "&f_unit=nN",
     {"bodies": {"radius": 1e-5, "stiffness": 1e9/(1 - 0.35**2)},
      "force": {"law": "lennard_jones", "hamaker": 2e-20, "z0": 0.2e-9},
      "device": {"stiffness": 0.3}, "fixed_load": {"load": -2e-8}}),
    ("#r1=10&r1_unit=nm&e1=70&n1=0.2&e2=&w=30&z0=0.3&k=1&f=5",
     {"bodies": {"radius": 1e-8, "young": [70e9, 1e20], "poisson": [0.2, 0.2]},
      "force": {"law": "lennard_jones", "surface_energy": 0.03, "z0": 0.3e-9},
      "device": {"stiffness": 1.0}, "fixed_load": {"load": 5e-9}})])
def test_numbers_are_the_program_s(window, values, deck):
    window.open(ADDRESS + values)
    law = window.run("""const {law, behind, state} = window.calculated;
        return {tabor: law.tabor, pullOff: law.pullOff, snapIn: law.snapIn, snapOff: law.snapOff,
          radius: law.radius, energyLost: law.energyLost, behind, state, z0: law.z0}""")
    radius = law["state"]["radius"]
    reach = 3*radius**2/law["radius"] + 10*law["z0"]
    # The spring lands far away.
    start = max(40*law["z0"], 2*law["behind"]["off"]["from"]["z"])
    result = snapin.run({**deck, "equilibrium_path": {"h0_start": start, "h0_end": -reach}})
    summary = result.summary
    assert law["tabor"] == pytest.approx(summary["tabor"], rel=1e-9)
    assert law["pullOff"] == pytest.approx(summary["max_tension"], rel=1e-6)
    assert (law["snapIn"] is not None) == ("jump_in_h0" in summary)
    if "jump_in_h0" in summary:
        assert law["snapIn"] == pytest.approx(summary["jump_in_h0"], abs=1e-5*law["z0"])
        assert law["snapOff"] == pytest.approx(summary["jump_out_h0"], abs=1e-5*law["z0"])
        assert law["energyLost"] == pytest.approx(summary["energy_lost"], rel=1e-4)
    # The stable state in contact under the load.
    state = result.fixed_load[np.argmax(result.fixed_load["contact_radius"])]
    assert state["stable"] == 1
    assert law["state"]["radius"] == pytest.approx(state["contact_radius"], rel=1e-4)
    assert law["state"]["h0"] == pytest.approx(state["h0"], abs=1e-4*law["z0"])
    # The jumps of the spring: before and after.
    for name, key in (("in", "device_jump_in"), ("off", "device_jump_out")):
        jump, z = law["behind"][name], summary[f"{key}_z"][0]
        tolerance = 1e-4*(law["z0"] + law["pullOff"]/deck["device"]["stiffness"])
        assert jump["from"]["z"] == pytest.approx(z, abs=tolerance)
        # A turn's load is as uncertain as the root of its place.
        assert jump["from"]["load"] == pytest.approx(summary[f"{key}_load"][0],
                                                     abs=1e-4*law["pullOff"])
        assert jump["to"]["load"] == pytest.approx(summary[f"{key}_load_after"][0],
                                                   abs=1e-4*law["pullOff"])
    assert law["behind"]["energyLost"] == pytest.approx(summary["device_energy_lost"][0], rel=1e-4)
    # What is shown has four digits of these.
    assert shown(text_of(window, "pull_off")) == pytest.approx(summary["max_tension"], rel=1e-3)
    assert shown(text_of(window, "contact_radius")) == pytest.approx(state["contact_radius"],
                                                                     rel=1e-3)
    assert float(text_of(window, "tabor").split()[0]) == pytest.approx(summary["tabor"], rel=1e-3)


@needs_browser
def test_theories_are_those_of_the_package(window):
    window.open(ADDRESS)
    found = window.run("""const {law, theory} = window.calculated, at = key => theory[key].at(2e-7);
        return {jkr: [theory.jkr.pullOff, at('jkr')], dmt: [theory.dmt.pullOff, at('dmt')],
          maugis: [theory.maugis.pullOff, at('maugis')], lambda: theory.lambda,
          tabor: law.tabor, radius: law.radius, modulus: law.reducedModulus}""")
    # Lambda of the largest tension of Lennard-Jones is 1.157 times Tabor's parameter.
    assert found["lambda"] == pytest.approx(1.157*found["tabor"], rel=1e-3)
    bodies = {"radius": found["radius"], "stiffness": 2*found["modulus"], "surface_energy": 0.05}
    for theory in ("jkr", "dmt", "maugis"):
        pull_off, state = found[theory]
        # The largest tension of the force, in Pa.
        extra = {"strength": 16/(9*3**0.5)*0.05/0.3e-9} if theory == "maugis" else {}
        expected = snapin.pull_off(theory, **bodies, control="load", **extra)
        assert -pull_off == pytest.approx(float(np.ravel(expected)[0]), rel=1e-4)
        radius = snapin.contact_radius(theory, "load", [2e-7], **bodies, **extra)
        assert state["radius"] == pytest.approx(float(np.ravel(radius)[-1]), rel=1e-4)


@needs_browser
def test_the_address_keeps_the_values(window):
    window.open(ADDRESS)
    assert "#" not in window.run("return location.href")
    window.run("const r = document.getElementById('r1'); r.value = '12.5';"
               "r.dispatchEvent(new Event('input', {bubbles: true}));"
               "const u = document.getElementById('e1_unit'); u.value = 'MPa';"
               "u.dispatchEvent(new Event('input', {bubbles: true}))")
    address, force = window.run("return [location.href, window.calculated.law.pullOff]")
    assert "r1=12.5" in address and "e1_unit=MPa" in address
    window.open(address)
    assert window.run("return [document.getElementById('r1').value, window.calculated.law.pullOff]"
                      ) == ["12.5", force]
    # Foreign parts of an address do nothing.
    window.open(ADDRESS + "#frog=1&r1=%E0%A4%A&k_unit=frogs&z0=0.4")
    assert window.run("return [document.getElementById('z0').value,"
                      "document.getElementById('k_unit').value]") == ["0.4", "N/m"]
    assert window.complaints() == []


@needs_browser
def test_it_can_be_used_by_keyboard(window):
    window.open(ADDRESS)
    seen = []
    for _ in range(40):
        window.type(TAB)
        seen.append(window.run("return document.activeElement.id"))
    wanted = window.run("return [...document.querySelectorAll('input, select, textarea, button')]"
                        ".filter(one => one.offsetParent).map(one => one.id)")
    assert [one for one in seen if one in wanted][:len(wanted)] == wanted
    # The focus is visible.
    window.run("document.getElementById('w').focus(); document.getElementById('w').select()")
    window.type(TAB)
    width = window.run("return getComputedStyle(document.activeElement).outlineWidth")
    assert float(width[:-2]) >= 2
    window.run("document.getElementById('w').focus(); document.getElementById('w').select()")
    window.type("100")
    assert window.run("return window.calculated.law.work") == pytest.approx(0.1)
    assert "w=100" in window.run("return location.hash")


@needs_browser
@pytest.mark.parametrize("field, value, said", [
    ("r1", "", "first radius"), ("e1", "-3", "first Young"), ("n2", "0.7", "second Poisson"),
    ("z0", "x", "equilibrium gap"), ("w", "0", "work of adhesion"), ("f", "1e", "load")])
def test_wrong_values_are_named_and_give_no_numbers(window, field, value, said):
    window.open(f"{ADDRESS}#{field}={value}")
    assert said in text_of(window, "problem")
    assert window.run(f"return document.getElementById('{field}').getAttribute('aria-invalid')"
                      ) == "true"
    assert window.run("return [window.calculated === undefined,"
                      "getComputedStyle(document.getElementById('pull_off') || "
                      "document.getElementById('numbers')).visibility]") == [True, "hidden"]
    # A comma is a decimal point in many countries.
    window.open(f"{ADDRESS}#r1=2,5&f=−10")
    assert window.run("return [window.calculated.values.r1, window.calculated.values.f]"
                      ) == pytest.approx([2.5e-6, -1e-8])
    assert text_of(window, "problem") == ""


@needs_browser
def test_every_field_and_picture_has_a_name(window):
    window.open(ADDRESS)
    unnamed = window.run("""return [...document.querySelectorAll('input, select, textarea')]
        .filter(one => !(one.labels && one.labels.length) && !one.getAttribute('aria-label'))
        .map(one => one.id)""")
    assert unnamed == []
    names = window.run("return [...document.querySelectorAll('svg[role=img]')]"
                       ".map(one => one.getAttribute('aria-label'))")
    assert len(names) == 2 and all("Pull-off force 1.2" in name for name in names)
    assert "NaN" not in window.run("return document.documentElement.outerHTML.split('<script>')[0]")


@needs_browser
def test_numbers_of_earlier_values_do_not_remain(window):
    window.open(ADDRESS)
    assert text_of(window, "pull_off")
    window.run("const r = document.getElementById('r1'); r.value = '';"
               "r.dispatchEvent(new Event('input', {bubbles: true}))")
    assert text_of(window, "pull_off") == ""


@needs_browser
@pytest.mark.parametrize("values, said", [
    ("", ""), ("#e1=100&e1_unit=kPa&f=20&f_unit=µN", "contact radius is"),
    ("#e1=10&e1_unit=MPa", "largest tension of the force")])
def test_bodies_beyond_the_model_are_told(window, values, said):
    window.open(ADDRESS + values)
    assert said in text_of(window, "caution")
    assert bool(said) == bool(text_of(window, "caution"))


@needs_browser
def test_the_deck_is_one_that_the_program_runs(window, snapin_path, tmp_path):
    window.open(ADDRESS + "#f=150")
    deck = window.run("return document.getElementById('deck').value")
    result = snapin.run(deck)
    law = window.run("return window.calculated.law")
    assert result.summary["max_tension"] == pytest.approx(law["pullOff"], rel=1e-6)
    assert result.summary["fixed_load"][0] == pytest.approx(1.5e-7)
    assert "device_jump_in_z" in result.summary


@needs_browser
@pytest.mark.parametrize("values", [
    "", "#k=", "#r1=1&r1_unit=nm&e1=200&k=0.1", "#e1=50&e1_unit=kPa", "#k=1&k_unit=kN/m&f=0",
    "#f=-1e5"])
def test_it_fits_a_telephone(telephone, values):
    telephone.open(ADDRESS + values)
    assert telephone.run("return document.documentElement.scrollWidth") <= 390
    assert telephone.run("return window.innerWidth") == 390
    assert telephone.run("return window.calculated !== undefined")
    assert telephone.complaints() == []
    boxes = telephone.run("""return [...document.querySelectorAll('input, button, select')].filter(
        one => one.offsetParent).map(one => one.getBoundingClientRect().height)""")
    assert min(boxes) >= 32
    paths = telephone.run("return [...document.querySelectorAll('svg path')].map("
                          "one => one.getAttribute('d'))")
    assert not any("NaN" in json.dumps(path) for path in paths)
