"""JavaScript of the contact law, and the calculator: one page of HTML that contains it."""

import json
import pathlib

from snapin._contact_tables import DEEP_PANELS

FOLDER = pathlib.Path(__file__).resolve().parent


def script_text(law):
    """Return the law in JavaScript."""
    kept = {name: value for name, value in law.items() if name not in ("errors", "force")}
    text = (FOLDER / "snapin_contact.js.in").read_text(encoding="utf-8")
    text = text.replace("@DEEP@", str(DEEP_PANELS))
    return text.replace("@LAW@", json.dumps(kept, separators=(",", ":")))


def page_text(law):
    """Return the page's text."""
    text = (FOLDER / "calculator.html.in").read_text(encoding="utf-8")
    return text.replace("@SCRIPT@", script_text(law).strip())
