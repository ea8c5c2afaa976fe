"""Training packs: small pictures, decoded once, in plain .npy files that are mapped into memory."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any, Dict, Optional, Sequence, Tuple

import numpy as np

from ._calls import PathLike, Progress
from ._dataset import Dataset
from ._show import Bars

TYPES = {"rgb": np.uint8, "depth": np.float16, "semantic": np.uint8, "instance": np.uint32, "normals": np.uint8}
CHUNK = 64


def pack(
    dataset: PathLike,
    out: PathLike,
    *,
    size: Tuple[int, int] = (224, 126),
    channels: Sequence[str] = ("rgb", "depth"),
    threads: Optional[int] = None,
    progress: Progress = True,
) -> "Pack":
    """Write a training pack: every frame of a dataset at ``size`` (width, height), one ``<channel>.npy`` per channel.

    ``rgb.npy`` is uint8 (frames, height, width, 3), ``depth.npy`` float16 metres (infinite for the sky; error at most 1
    in 2,048), ``semantic.npy`` uint8, ``instance.npy`` uint32. ``pack.json`` lists the trajectories with their first
    frame. The folder appears when it is whole.
    """
    out, frames = Path(out), Dataset(dataset, channels=channels, size=size, threads=threads or os.cpu_count() or 1)
    if out.exists():
        raise FileExistsError(f"{out} is there already; choose another folder")
    out.parent.mkdir(parents=True, exist_ok=True)
    scratch = Path(tempfile.mkdtemp(prefix=".cosfly-pack-", dir=out.parent))
    try:
        shape = (len(frames), size[1], size[0])
        arrays = {
            name: np.lib.format.open_memmap(
                scratch / f"{name}.npy", mode="w+", dtype=TYPES[name],
                shape=(*shape, 3) if name in ("rgb", "normals") else shape,
            )  # fmt: skip
            for name in channels
        }
        with Bars("pack", bool(progress)) as bars:
            for start in range(0, len(frames), CHUNK):
                wanted = frames._index[start : start + CHUNK]
                for name, images in frames._images(wanted, channels, size).items():
                    arrays[name][start : start + len(wanted)] = np.stack(images)
                done = start + len(wanted)
                if callable(progress):
                    progress({"pack": (done, len(frames))})
                elif bars.visible:
                    bars.show({"pack": (done, len(frames))})
        for array in arrays.values():
            array.flush()
        first, places = 0, {}
        counts = dict(zip(frames._reader.trajectory_ids, frames._reader.frames))
        for name in frames.trajectory_ids:
            places[name], first = first, first + counts[name]
        about = {"format": "cosfly-pack-1", "size": list(size), "channels": list(channels), "first_frame": places}
        (scratch / "pack.json").write_text(json.dumps(about, indent=1) + "\n", encoding="utf-8")
        os.chmod(scratch, 0o755)
        os.rename(scratch, out)
    except BaseException:
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    return Pack(out, dataset)


class Pack(Dataset):
    """Samples of a dataset whose pictures come from a training pack.

    Takes the options of :class:`cosfly.Dataset` but ``size``, and gives the same samples; depth is float16.
    """

    def __init__(self, path: PathLike, dataset: PathLike, **options: Any):
        self.pack_path = Path(path)
        try:
            about = json.loads((self.pack_path / "pack.json").read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise FileNotFoundError(f"{path} is no training pack: it has no pack.json; `cosfly.pack` writes one") from None
        if about.get("format") != "cosfly-pack-1":
            raise ValueError(f"{path} has the format {about.get('format')!r}; this version reads 'cosfly-pack-1'")
        self._first: Dict[str, int] = about["first_frame"]
        self._arrays: Dict[str, np.ndarray] = {}
        options.setdefault("channels", tuple(about["channels"]))
        super().__init__(dataset, size=tuple(about["size"]), **options)
        for name in self.channels:
            self._array(name)

    def _array(self, channel: str) -> np.ndarray:
        if channel not in self._arrays:
            path = self.pack_path / f"{channel}.npy"
            if not path.exists():
                raise ValueError(f"{self.pack_path} has no channel {channel!r}")
            self._arrays[channel] = np.load(path, mmap_mode="r")
        return self._arrays[channel]

    def _images(self, frames: Any, channels: Sequence[str], size: Any) -> Dict[str, Any]:
        places = [self._first[name] + int(frame) for name, frame in frames]
        return {channel: [self._array(channel)[place] for place in places] for channel in channels}

    def __getstate__(self) -> Dict[str, Any]:
        return {**super().__getstate__(), "_arrays": {}}
