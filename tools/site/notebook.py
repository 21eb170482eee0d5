"""Execute docs/notebook.ipynb, and write it with its output as a page of the site.

    .venv/bin/python tools/site/notebook.py FOLDER
"""

import base64
import pathlib
import sys
import tempfile

import nbformat
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NOTEBOOK = ROOT / "docs/notebook.ipynb"
# Longest time of a cell [s].
_PATIENCE = 300


def executed():
    """Return the notebook with the output of its cells; an error in a cell is raised."""
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        # Without a network the kernel is reached through sockets in the file system.
        kernel = AsyncKernelManager(kernel_name="python3", transport="ipc", ip=f"{folder}/kernel")
        NotebookClient(notebook, km=kernel, timeout=_PATIENCE,
                       resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    return notebook


def page_of(notebook):
    """Return the text of the page, and its pictures by name."""
    lines, pictures = [], {}
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            lines += [cell.source, ""]
            continue
        lines += ["```python", cell.source, "```", ""]
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                name = f"notebook_{len(pictures) + 1}.png"
                pictures[name] = base64.b64decode(data["image/png"])
                lines += [f"![Output of the cell]({name})", ""]
            elif output.get("text") or "text/plain" in data:
                text = output.get("text") or data["text/plain"]
                lines += ["```text", text.rstrip(), "```", ""]
    lines += [f"The notebook as a file: [{NOTEBOOK.name}]({NOTEBOOK.name})", ""]
    return "\n".join(lines), pictures


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    text, pictures = page_of(executed())
    (folder / "notebook.md").write_text(text, encoding="utf-8")
    (folder / NOTEBOOK.name).write_bytes(NOTEBOOK.read_bytes())
    for name, picture in pictures.items():
        (folder / name).write_bytes(picture)


if __name__ == "__main__":
    main()
