"""Training packs: small pictures, decoded once, in plain .npy files."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
import threading
from pathlib import Path
from typing import Any, Container, Sequence

import numpy as np

from . import _cosfly
from ._calls import PathLike, Progress
from ._dataset import Dataset, warn_of_small_targets
from ._errors import InvalidValue, OutOfRange, WrongType, options, path_of
from ._show import Bars

FORMAT = "cosfly-pack-2"
CHUNK = 64


@options()
def pack(
    dataset: PathLike,
    out: PathLike,
    *,
    size: tuple[int, int] = (224, 126),
    channels: str | Sequence[str] = ("rgb", "depth"),
    split: str | None = None,
    role: str | None = None,
    trajectories: str | Sequence[str] | None = None,
    jobs: int | None = None,
    progress: Progress = True,
) -> "Pack":
    """Write a training pack: every frame of a dataset at ``size`` (width, height), one ``<channel>.npy`` per channel.

    ``split``, ``role`` and ``trajectories`` choose as those of :class:`cosfly.Dataset`; without them every flight is packed.

    ``rgb.npy`` is uint8 (frames, height, width, 3), ``depth.npy`` float16 metres (infinite for the sky; error at most 1
    in 2,048), ``semantic.npy`` uint8, ``instance.npy`` uint32. ``pack.json`` lists the trajectories with their first
    frame, and the identity of the dataset: :class:`cosfly.Pack` refuses labels of another one. The folder appears when it
    is whole.
    """
    out, jobs = Path(path_of(out)), jobs or os.cpu_count() or 1
    frames = Dataset(dataset, split=split, role=role, trajectories=trajectories, channels=channels, size=size, jobs=jobs)
    if os.path.lexists(out):
        raise InvalidValue(f"{out} is there already; choose another folder")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=".cosfly-pack-", dir=out.parent))
    except OSError as error:
        raise _refused(f"write into `{out.parent}`", error) from None
    try:
        warn_of_small_targets(frames, _boxes(frames))
        with Bars("pack", bool(progress)) as bars:
            _write(frames, scratch, progress if callable(progress) else bars.show if bars.visible else None)
        frames.check()  # a dataset that was made anew meanwhile gave pictures of two
        os.chmod(scratch, 0o755)
        os.rename(scratch, out)
    except OSError as error:
        shutil.rmtree(scratch, ignore_errors=True)
        raise _refused(f"write the pack `{out}`", error) from None
    except BaseException:
        shutil.rmtree(scratch, ignore_errors=True)
        raise
    return Pack(out, dataset)


def _boxes(frames: Dataset) -> Any:
    """Trajectory and visible box of each packed frame, where the data have boxes."""
    table = frames.table("frames")
    names = set(name for name, _ in frames._index)
    boxes = zip(table["trajectory_id"], table["visible_box_px"]) if "visible_box_px" in table.columns else ()
    return ((name, box) for name, box in boxes if name in names)


def _write(frames: Dataset, folder: Path, progress: Any) -> None:
    """Writes the files of a pack with plain writes: a full disk is an error of a write, but a crash of a mapped file."""
    if not len(frames):
        raise InvalidValue(f"{frames.path} has no frames to pack")
    files = {name: open(folder / f"{name}.npy", "wb") for name in frames.channels}
    try:
        for start in range(0, len(frames), CHUNK):
            wanted = frames._index[start : start + CHUNK]
            for name, images in frames._images(wanted, frames.channels, frames.size).items():
                # The element of a channel is that of its pictures; numbers are kept in half the bytes.
                stacked = np.stack(images)
                stacked = stacked.astype(np.float16) if stacked.dtype == np.float32 else stacked
                if start == 0:
                    shape = (len(frames), *stacked.shape[1:])
                    about = {"descr": np.lib.format.dtype_to_descr(stacked.dtype), "fortran_order": False, "shape": shape}
                    np.lib.format.write_array_header_1_0(files[name], about)
                files[name].write(stacked.tobytes())
            if progress:
                progress({"pack": (start + len(wanted), len(frames))})
    finally:
        for file in files.values():
            file.close()
    places: dict[str, int] = {}
    for place, (name, _) in enumerate(frames._index):
        places.setdefault(name, place)
    about = {
        "format": FORMAT, "dataset": {"identity": frames.identity, "path": os.fspath(frames.path)},
        "size": list(frames.size or (0, 0)), "channels": list(frames.channels), "first_frame": places,
    }  # fmt: skip
    (folder / "pack.json").write_text(json.dumps(about, indent=1) + "\n", encoding="utf-8")


class Pack(Dataset):
    """Samples of a dataset whose pictures come from a training pack.

    Takes the options of :class:`cosfly.Dataset` but ``size``, and gives the same samples; depth is float16.
    ``Pack(...).windows()`` are its training windows. A pack of some flights has the samples of these.

    :meth:`array` is all pictures of a channel, and ``rows`` the places of each sample's pictures in it.
    """

    def __init__(self, path: PathLike, dataset: PathLike, **options: Any):
        self.pack_path = Path(path_of(path))
        if "size" in options:
            raise WrongType("a pack has the size that it was made with; leave out `size`, or make another pack with `cosfly.pack`")
        about, self._seal = _about(self.pack_path)
        self._first: dict[str, int] = about["first_frame"]
        self._frames: dict[str, Frames] = {}
        options.setdefault("channels", tuple(about["channels"]))
        self._source: dict[str, Any] = about["dataset"]
        super().__init__(dataset, size=tuple(about["size"]), **options)
        absent = [name for name, _ in self._index if name not in self._first]
        if absent or not self._index:
            asked = f"trajectory {absent[0]!r}" if absent else f"split {self.split!r} and role {self.role!r}"
            raise InvalidValue(f"{self.pack_path} has no pictures of {asked}; `cosfly.pack` chose the flights, of {len(self._first)} trajectories")
        for name in self.channels:
            self._frames_of(name)

    def _chosen(self, trajectories: str | Sequence[str] | None) -> Container[str]:
        """Those of the pack without others; of another dataset they would have other names."""
        if self._source["identity"] != self.identity:
            given = str(self._source["path"]), str(self._source["identity"])
            raise _cosfly.pack_of_other(os.fspath(self.pack_path), os.fspath(self.path), given, self.identity)
        return self._first if trajectories is None else super()._chosen(trajectories)

    def array(self, channel: str) -> np.ndarray:
        """All pictures of a channel: (frames of the pack, H, W) or (frames, H, W, 3)."""
        frames = self._frames_of(channel)
        return frames.read(0, frames.count)

    @property
    def rows(self) -> np.ndarray:
        """Place of each sample's picture in the arrays."""
        return np.array(self._rows_of(self._index), dtype=np.int64)

    def _rows_of(self, frames: Sequence[tuple[str, int]]) -> list[int]:
        return [self._first[name] + int(frame) for name, frame in frames]

    def _frames_of(self, channel: str) -> "Frames":
        if channel not in self._frames:
            path = self.pack_path / f"{channel}.npy"
            if not path.exists():
                raise InvalidValue(f"{self.pack_path} has no channel {channel!r}")
            self._frames[channel] = Frames(path, self._seal)
            width, height = self.size or (0, 0)
            expected = (sum(self._counts[self._number_of(name)] for name in self._first), height, width)
            if (self._frames[channel].count, *self._frames[channel].shape[:2]) != expected:
                raise _cosfly.damaged_pack(os.fspath(path), f"its frames, height and width are not {expected}, as pack.json has them")
        return self._frames[channel]

    def _images(self, frames: Any, channels: Sequence[str], size: Any) -> dict[str, Any]:
        if size is not None and tuple(size) != self.size:
            raise InvalidValue(f"the pack {self.pack_path} has pictures of {self.size}; another size takes another pack")
        self._places(frames)
        places = self._rows_of(frames)
        return {channel: self._stacked(places, channel) for channel in channels}

    def _stacked(self, places: list[int], channel: str) -> np.ndarray:
        frames = self._frames_of(channel)
        made = np.empty((len(places), *frames.shape), frames.dtype)
        first = 0
        for end in range(1, len(places) + 1):  # frames of a window lie side by side
            if end == len(places) or places[end] != places[end - 1] + 1:
                frames.read_into(made[first:end], places[first])
                first = end
        return made


class Frames:
    """The pictures of a channel: rows of a .npy file, read when asked for.

    They are read, not mapped: a file that is cut while it is mapped ends the process with a signal, a read is an error.
    """

    def __init__(self, path: Path, seal: str):
        self.path, self._seal, self._opened = path, seal, (-1, -1)
        self._lock = threading.Lock()
        with open(path, "rb") as file:
            try:
                version = np.lib.format.read_magic(file)
                shape, is_fortran, self.dtype = np.lib.format.read_array_header_1_0(file)
            except ValueError as error:
                raise _cosfly.damaged_pack(os.fspath(path), str(error)) from None
            self.start = file.tell()
        if version != (1, 0) or is_fortran or len(shape) < 3 or self.dtype.hasobject:
            raise _cosfly.damaged_pack(os.fspath(path), f"it has the shape {shape}")
        self.count, self.shape = shape[0], shape[1:]
        self.bytes = int(np.prod(self.shape)) * self.dtype.itemsize

    def read(self, first: int, count: int) -> np.ndarray:
        """Pictures ``first`` to ``first + count``, as one array."""
        made = np.empty((count, *self.shape), self.dtype)
        self.read_into(made, first)
        return made

    def read_into(self, made: np.ndarray, first: int) -> None:
        """Pictures from ``first`` on, as many as ``made`` has."""
        if not 0 <= first <= self.count - len(made):
            raise OutOfRange(f"{self.path} has {self.count} frames, not {first + len(made)}")
        whole = memoryview(made).cast("B")
        try:
            done = self._read_at(whole, self.start + first * self.bytes)
        except OSError as error:
            raise _refused(f"read `{self.path}`", error) from None
        if done != len(whole):
            raise _cosfly.damaged_pack(os.fspath(self.path), "it ends too early: it was changed, or written incompletely")

    def _read_at(self, into: memoryview, place: int) -> int:
        file, done = self._file(), 0
        while done < len(into):
            if hasattr(os, "preadv"):
                read = os.preadv(file, [into[done:]], place + done)
            else:  # Windows and older macOS: one reader at a time moves the position of the file
                with self._lock:
                    os.lseek(file, place + done, os.SEEK_SET)
                    part = os.read(file, len(into) - done)
                    into[done : done + len(part)] = part
                    read = len(part)
            if read == 0:
                break
            done += read
        return done

    def _file(self) -> int:
        process, file = self._opened
        if process != os.getpid():  # a fork opens its own file
            try:
                file = os.open(self.path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
            except OSError as error:
                raise _refused(f"open `{self.path}`", error) from None
            self._opened = (os.getpid(), file)
            if _about(self.path.parent)[1] != self._seal:
                raise _cosfly.changed_pack(os.fspath(self.path.parent))
        return file

    def __del__(self) -> None:
        process, file = getattr(self, "_opened", (-1, -1))
        if process == os.getpid():
            os.close(file)

    def __getstate__(self) -> dict[str, Any]:
        state = {**self.__dict__, "_opened": (-1, -1)}
        state.pop("_lock")
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._lock = threading.Lock()


def _about(pack: Path) -> tuple[dict[str, Any], str]:
    """What ``pack.json`` says, and a digest of it."""
    path = pack / "pack.json"
    try:
        text = path.read_bytes()
        about = json.loads(text.decode())
    except FileNotFoundError:
        raise InvalidValue(f"{pack} is no training pack: it has no pack.json; `cosfly.pack` writes one") from None
    except OSError as error:
        raise _refused(f"read `{path}`", error) from None
    except ValueError:
        raise _cosfly.damaged_pack(os.fspath(path), "it is not JSON") from None
    form = about.get("format") if isinstance(about, dict) else None
    if form == "cosfly-pack-1":
        raise InvalidValue(f"{pack} was made by an older cosfly and does not say of which dataset; `cosfly.pack` makes a new pack")
    if form != FORMAT:
        raise InvalidValue(f"{pack} has the format {form!r}; this version reads {FORMAT!r}")
    kinds = {"dataset": dict, "size": list, "channels": list, "first_frame": dict}
    wrong = [name for name, kind in kinds.items() if not isinstance(about.get(name), kind)]
    if wrong or not {"identity", "path"} <= about["dataset"].keys():
        raise _cosfly.damaged_pack(os.fspath(path), f"it has no {' and no '.join(wrong) or 'identity of its dataset'}")
    return about, hashlib.sha256(text).hexdigest()


def _refused(action: str, error: OSError) -> Exception:
    """The refusal of the command line for an error of the system."""
    return _cosfly.refused_by_machine(action, error.errno or 0)
