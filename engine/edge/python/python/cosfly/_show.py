"""Progress bars, and pictures of datasets in notebooks."""

from __future__ import annotations

import base64
import html
import shutil
import sys
from typing import Any, Dict, List, Tuple


class Bars:
    """Progress of a call, in a terminal or a notebook; nothing elsewhere."""

    def __init__(self, name: str, wanted: bool, stream: Any = None):
        self.name, self.stream, self.display = name, stream or sys.stderr, None
        self.notebook = wanted and _is_notebook()
        self.terminal = wanted and not self.notebook and bool(getattr(self.stream, "isatty", lambda: False)())
        self.visible = self.notebook or self.terminal

    def __enter__(self) -> "Bars":
        return self

    def show(self, progress: Dict[str, Any]) -> None:
        """Show {name of the work: (done, all)}."""
        parts = [(name, int(done), int(whole)) for name, (done, whole) in progress.items()]
        if self.notebook:
            from IPython.display import HTML, display

            rows = "".join(
                f"<tr><td>{html.escape(name)}</td><td><progress value='{done}' max='{whole}'></progress></td>"
                f"<td>{done}/{whole}</td></tr>"
                for name, done, whole in parts
            )
            page = HTML(f"<table>{rows}</table>")
            if self.display is None:
                self.display = display(page, display_id=True)
            else:
                self.display.update(page)
        elif self.terminal:
            open_parts = [f"{name} {done}/{whole}" for name, done, whole in parts if done < whole] or [self.name]
            width = shutil.get_terminal_size().columns - 1
            self.stream.write("\r\x1b[K" + ", ".join(open_parts)[:width])
            self.stream.flush()

    def __exit__(self, *_: Any) -> None:
        if self.terminal:
            self.stream.write("\r\x1b[K")
            self.stream.flush()


def dataset_html(dataset: Any, pictures: int = 4) -> str:
    """A dataset as a page: its size, and previews of some trajectories."""
    table = dataset.table("frames")
    cells: List[str] = []
    if "preview" in table.columns:
        names, files = table["trajectory_id"], table["preview"]
        step = max(1, len(names) // pictures)
        for row in range(0, len(names), step)[:pictures]:
            data = files[row]
            if data:
                code = base64.b64encode(bytes(data)).decode()
                cells.append(
                    f"<figure style='display:inline-block'><img src='data:image/jpeg;base64,{code}'>"
                    f"<figcaption>{html.escape(names[row])}</figcaption></figure>"
                )
    return f"<p>{html.escape(repr(dataset))}</p>{''.join(cells)}"


def image_html(path: Any) -> str:
    """A picture file inside a page."""
    kind = {".png": "png", ".gif": "gif"}.get(path.suffix, "jpeg")
    code = base64.b64encode(path.read_bytes()).decode()
    return f"<img style='max-width:100%' src='data:image/{kind};base64,{code}'>"


def rerun(dataset: Any, trajectory_id: str) -> None:
    """Show a trajectory in Rerun's viewer; needs the package ``rerun-sdk``."""
    import rerun as viewer

    viewer.init(f"cosfly {trajectory_id}", spawn=True)
    table = dataset.table("trajectories")
    row = table["trajectory_id"].index(trajectory_id)
    viewer.log_file_from_path(str(dataset.path / table["mcap_path"][row]))


def _is_notebook() -> bool:
    module = sys.modules.get("IPython")
    shell = module.get_ipython() if module else None
    return shell is not None and shell.__class__.__name__ == "ZMQInteractiveShell"


Size = Tuple[int, int]
