"""The C header of a contact law, from its tables."""

import pathlib
import textwrap

from law_errors import KINDS
from law_states import jkr_root
from snapin._contact_tables import DEEP_PANELS, GAP, SPREAD

TEMPLATE = pathlib.Path(__file__).with_name("snapin_contact.h.in")
LICENSE = pathlib.Path(__file__).resolve().parents[2] / "LICENSE"


class Numbers:
    """One list of whole numbers for all tables, and where each begins."""

    def __init__(self):
        self.numbers, self.starts = [], []

    def add(self, table):
        """Append a table and return its place in the list of tables."""
        self.starts.append(len(self.numbers))
        self.numbers.append(len(table["rows"]))
        for row in table["rows"]:
            self.numbers += [len(row), *row]
        if max(map(abs, self.numbers)) >= 2**31:
            raise OverflowError("a coefficient exceeds 32 bits")
        return len(self.starts) - 1

    def add_tiles(self, tiles):
        """Append the tables of tiles and return the place of the first."""
        return [self.add(table) for tile in tiles for table in tile][0]


def array(kind, name, values):
    """Return the definition of an array in lines of up to 100 columns."""
    text = textwrap.fill(", ".join(map(str, values)), 98, initial_indent="  ",
                         subsequent_indent="  ")
    return f"static const {kind} {name}[] = {{\n{text.replace(', ', ',')}}};"


def tables_text(law):
    """Return the C definitions of a law's numbers."""
    store = Numbers()
    near, deep = [], []
    for panel in law["near"]:
        near.append((panel, store.add_tiles(panel["outside"] + panel["contact"])))
        if panel["energy"]:
            store.add(panel["energy"])
    for panel in law["deep"]:
        deep.append((panel, store.add_tiles(panel["tiles"])))
    wall = store.add(law["wall"])
    most = [max(len(panel[name]) for panel, _ in near)
            for name in ("outside_edges", "contact_edges")]

    def braced(values):
        return "{" + ", ".join(f"{value:.17g}" for value in values) + "}"

    constants = {
        "unit": law["wall"]["unit"], "rest": law["rest"], "power": law["power"],
        "tail": -law["tail"], "decay": law["decay"] or 1.0, "least": law["least"],
        "largest": law["largest"], "lowest": law["lowest"],
        "highest": law["highest"],
        "gap_of_mu": GAP,
        "radius_of_sigma": SPREAD, "join_load": law["join_load"],
        "join_root": float(jkr_root(law["join_load"])),
        "wall_low": law["wall_low"], "wall_high": law["wall_high"]}
    lines = [f"static const double snapin_contact_{name}_ = {value:.17g};"
             for name, value in constants.items()]
    lines += [
        f"#define SNAPIN_CONTACT_DEEP {DEEP_PANELS}",
        f"#define SNAPIN_CONTACT_TILES {len(law['deep_edges']) - 1}",
        f"#define SNAPIN_CONTACT_WALL_ORDER {len(law['wall']['rows'][0])}",
        f"#define SNAPIN_CONTACT_WALL_TABLE {wall}",
        "typedef struct {",
        "  int last, whole, by_sigma, table, outside, contact;",
        "  double low, high, offset, exponent;",
        f"  double outside_edges[{most[0]}], contact_edges[{most[1]}];",
        "} snapin_contact_near_panel;",
        "typedef struct {",
        "  int last, table;",
        "  double low, high;",
        "} snapin_contact_deep_panel;",
        "static const double snapin_contact_deep_edges_[SNAPIN_CONTACT_TILES + 1] = "
        + braced(law["deep_edges"]) + ";",
        "static const snapin_contact_near_panel snapin_contact_near_panels_[] = {"]
    for number, (panel, first) in enumerate(near):
        flags = [number == len(near) - 1, panel["whole"], panel["variable"] == "sigma"]
        whole = [*map(int, flags), first, len(panel["outside"]), len(panel["contact"])]
        real = [panel[name] for name in ("low", "high", "offset", "exponent")]
        lines += ["  {" + ", ".join(map(str, whole)) + ",",
                  "   " + ", ".join(f"{value:.17g}" for value in real) + ","]
        lines += ["   " + braced(panel["outside_edges"]) + ",",
                  "   " + braced(panel["contact_edges"]) + "},"]
    lines += ["};", "static const snapin_contact_deep_panel snapin_contact_deep_panels_[] = {"]
    lines += [f"  {{{int(number == len(deep) - 1)}, {first}, {panel['low']:.17g}, "
              f"{panel['high']:.17g}}}," for number, (panel, first) in enumerate(deep)]
    lines += ["};", array("int", "snapin_contact_tables_", store.starts),
              array("int", "snapin_contact_numbers_", store.numbers)]
    return "\n".join(lines)


def about(law):
    """Return the text of the first comment: which law, and how exact."""
    groups = "; ".join(
        f"&{name} " + ", ".join(f"{key} = {value}" for key, value in keys.items())
        for name, keys in law["force"].items())
    lines = textwrap.wrap(f"Force: {law['title']}, from a deck with {groups}. It scales with work "
                          "of adhesion and z0.", 98)
    for name in ("within", "below", "above"):
        found = law.get("errors", {}).get(name)
        if found:
            lines += ["", f"Largest errors {name} the range of tables: {found['states']} random "
                      "stable states of solved paths,",
                      f"Tabor's parameter {found['low']:.3g} to {found['high']:.3g}:"]
            lines += [f"  {value[0]:.1e}  {KINDS[kind]}"
                      for kind, value in found["largest"].items()]
    return "\n".join(lines)


def header_text(law):
    """Return the header's text."""
    panels = max(len(panel["outside"]) + len(panel["contact"]) for panel in law["near"])
    text = TEMPLATE.read_text(encoding="utf-8")
    for name, value in {"ABOUT": about(law), "ORDER": str(law["order"]),
                        "PANELS": str(panels + DEEP_PANELS),
                        "TABLES": tables_text(law),
                        "LICENSE": LICENSE.read_text(encoding="utf-8").strip()}.items():
        text = text.replace(f"@{name}@", value)
    return text
