"""Progress bars, and pictures of datasets in notebooks."""

from __future__ import annotations

import base64
import html
import shutil
import sys
import tempfile
from typing import Any

from . import _cosfly

LARGEST_REPORT = 8_000_000
"""Bytes of a report that is shown inside of a notebook."""


class Bars:
    """Progress of a call, in a terminal or a notebook; nothing elsewhere."""

    def __init__(self, name: str, wanted: bool, stream: Any = None):
        self.name, self.stream, self.display = name, stream or sys.stderr, None
        self.notebook = wanted and _is_notebook()
        self.terminal = wanted and not self.notebook and bool(getattr(self.stream, "isatty", lambda: False)())
        self.visible = self.notebook or self.terminal

    def __enter__(self) -> "Bars":
        return self

    def show(self, progress: dict[str, Any]) -> None:
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
    """A dataset as a page: its size, frames of some trajectories, and its report where it has one."""
    names = dataset.trajectory_ids
    chosen = names[:: max(1, len(names) // pictures)][:pictures]
    parts = [f"<p>{html.escape(repr(dataset))}</p>"]
    for name in chosen if "rgb" in (dataset.channels_of(names[0]) if names else []) else []:
        middle = len(dataset.trajectory(name)) // 2
        frame = dataset.frame(name, middle, channels=("rgb",), size=_thumbnail(dataset, name))
        parts.append(_figure(frame.png("rgb"), f"{name}, frame {middle}"))
    dataset.check()
    report = dataset.path / "report" / "index.html"
    if report.is_file() and report.stat().st_size <= LARGEST_REPORT:
        page = html.escape(report.read_text(encoding="utf-8"), quote=True)
        parts.append(f"<details><summary>report</summary><iframe sandbox srcdoc='{page}' style='width:100%;height:600px'></iframe></details>")
    return "".join(parts)


class Frame(dict[str, Any]):
    """Images of a frame by channel; notebooks show them."""

    def png(self, channel: str) -> bytes:
        """A PNG file: colours as they are, depth warm (near) to cold (far), labels in CARLA's colours, ids in a colour each."""
        import numpy as np

        image = self[channel]
        image = image.astype(np.float32) if image.dtype == np.float16 else image
        return _cosfly.shown(channel, np.ascontiguousarray(image).tobytes(), image.shape[1], image.shape[0])

    def _repr_html_(self) -> str:
        return "".join(_figure(self.png(channel), channel) for channel in self)


class Trajectory:
    """One flight of a dataset: ``len(it)`` frames, ``it[frame]`` its images. Notebooks show contact sheet, plan and clip."""

    def __init__(self, dataset: Any, trajectory_id: str, frames: int):
        self.dataset, self.trajectory_id, self._frames = dataset, trajectory_id, frames

    def __len__(self) -> int:
        return self._frames

    def __getitem__(self, frame: int) -> Frame:
        from ._dataset import numbered

        return self.dataset.frame(self.trajectory_id, numbered("frame", frame, len(self)))

    def __repr__(self) -> str:
        return f"<cosfly trajectory {self.trajectory_id} of {self.dataset.path}: {len(self)} frames>"

    def _repr_html_(self) -> str:
        text = f"<p>{html.escape(repr(self))}</p>"
        if (self.dataset.path / "data" / "trajectories").is_dir():
            return text + pictures_html(self.dataset, self.trajectory_id)
        size = _thumbnail(self.dataset, self.trajectory_id)
        for frame in range(0, len(self), max(1, len(self) // 6)):
            images = self.dataset.frame(self.trajectory_id, frame, channels=("rgb",), size=size)
            text += _figure(images.png("rgb"), f"frame {frame}")
        return text


class Town:
    """A town of a dataset, by the name that table ``trajectories`` has. Notebooks show its plan with the flights of a pedestrian."""

    def __init__(self, dataset: Any, name: str, trajectory_id: str):
        self.dataset, self.path, self.name, self.trajectory_id = dataset, dataset.path, name, trajectory_id

    def __repr__(self) -> str:
        return f"<cosfly town {self.name} of {self.path}>"

    def _repr_png_(self) -> bytes:
        from ._calls import preview

        self.dataset.check()
        with tempfile.TemporaryDirectory() as scratch:
            return preview(self.path, self.trajectory_id, frames="0", out=scratch, progress=False).plan.read_bytes()


def pictures_html(dataset: Any, trajectory_id: str) -> str:
    """Contact sheet, plan and clip of a flight, which leave no files."""
    from ._calls import preview

    dataset.check()
    with tempfile.TemporaryDirectory() as scratch:
        return preview(dataset.path, trajectory_id, out=scratch, progress=False)._repr_html_()


def _thumbnail(dataset: Any, trajectory_id: str) -> tuple[int, int]:
    if hasattr(dataset, "pack_path"):
        return dataset.size
    width, height = dataset.size_of(trajectory_id)
    return (320, max(1, 320 * height // width)) if width > 320 else (width, height)


def _figure(png: bytes, caption: str) -> str:
    code = base64.b64encode(png).decode()
    return (
        f"<figure style='display:inline-block'><img src='data:image/png;base64,{code}'>"
        f"<figcaption>{html.escape(caption)}</figcaption></figure>"
    )


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
