"""Samples of a dataset: pictures from the logs, and rows of its tables, as numpy arrays."""

from __future__ import annotations

import difflib
import operator
import os
import warnings
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _cosfly
from ._calls import PathLike
from ._cosfly import Reader, Table
from ._errors import InvalidValue, NotFound, OutOfRange, WrongType, options
from ._show import Frame, Town, Trajectory

ROLES = ("expert", "perturbed")
WINDOW_LISTS = {
    # Column of table `windows`: numbers per row of the array.
    "current_pose_in_world": 6,
    "input_steps_in_world": 6,
    "input_steps_in_body": 6,
    "correction_in_world": 6,
    "correction_in_body": 6,
    "waypoint_deltas_in_world": 6,
    "waypoint_deltas_in_body": 6,
    "input_boxes_px": 4,
}

Sample = Dict[str, Any]


class Dataset:
    """Frames of a dataset, by number; :meth:`windows` gives its training windows.

    ``path`` is a dataset of cosfly, a folder of the published v7 layout, or one of LeRobot (with pictures, not videos; of
    ``cosfly export`` or of others). ``dataset[i]`` is a dictionary. Pictures are read at random, decoded and scaled in Rust:

    * ``rgb``: uint8, (H, W, 3);
    * ``depth``: float32 metres, planar, infinite for the sky; ``semantic``: uint8, CARLA's labels; ``instance``: uint32;
    * ``trajectory_id``, ``frame``, and each of ``columns`` of table ``frames``;
    * ``captions`` where ``captions`` is a language: the text of each style, by its name (``""`` in other layouts).

    Foreign layouts give the tables ``trajectories``, ``frames``, ``captions`` and ``windows`` (of the default shape) with
    the columns whose values they hold: v7 has ``rgb``, ``depth``, ``semantic`` and ``instance``, LeRobot ``rgb`` alone.

    Scaled colours are the mean over each pixel's area; other channels are sampled at the middle of each pixel. Without
    ``size`` all channels are bit for bit what the files hold. The object is map-style: ``torch.utils.data.DataLoader``
    takes it as it is, workers included (each process opens its own files).

    The object keeps the ``identity`` of the dataset that was opened. Where the folder is made anew meanwhile, pictures and
    tables that are asked for later raise :class:`cosfly.Error` (``dataset-changed``), in worker processes, too: open it again.

    ``split`` is ``train``, ``val``, ``test`` or None for all; ``role`` is ``expert``, ``perturbed`` or None for both;
    ``size`` is (width, height); ``jobs`` threads decode the pictures of one call.
    """

    _unit = "frames"
    identity: str = ""
    """Digest that tells this dataset from others: of cosfly's own, the hash of ``files.parquet``."""

    @options(windows="the method `windows()` of the dataset", threads="`jobs`")
    def __init__(
        self,
        path: PathLike,
        *,
        split: Optional[str] = None,
        role: Optional[str] = None,
        channels: Sequence[str] = ("rgb", "depth"),
        size: Optional[Tuple[int, int]] = None,
        columns: Sequence[str] = (),
        captions: Optional[str] = None,
        jobs: int = 1,
    ):
        self.path = Path(path)
        self.split, self.role = split, role
        self.channels, self.size = tuple(channels), size
        self._opened: Tuple[int, Optional[Reader]] = (-1, None)
        self.jobs = _whole("jobs", jobs, 1)
        if split not in (None, "train", "val", "test"):
            raise InvalidValue(f"the split is {split!r}; splits are 'train', 'val' and 'test'")
        if role not in (None, *ROLES):
            raise InvalidValue(f"the role is {role!r}; roles are 'expert' and 'perturbed'")
        self.identity = self._reader.identity
        ids = self._reader.trajectory_ids
        if split and not any(self._reader.splits):
            raise InvalidValue(f"the data in {self.path} state no splits; leave out `split`")
        self._number = {name: number for number, name in enumerate(ids)}
        self._counts = self._reader.frames
        self.trajectory_ids: List[str] = [name for name, of in zip(ids, self._reader.splits) if split in (None, of)]
        """Ids of the trajectories of the split."""
        self._columns: Dict[str, Any] = {}
        self._index = self._frames_index(columns)
        self._captions = self._read_captions(captions) if captions else {}

    def windows(self) -> "Windows":
        """The training windows of the dataset, with the same split, role, channels, size and captions."""
        return Windows(self)

    # Tables and frames

    def table(self, name: str) -> Table:
        """A table of the split: ``table("trajectories")["town"]``, or ``pyarrow.table(dataset.table("frames"))``."""
        return self._reader.table(name, self.split)

    def frame(
        self, trajectory_id: str, frame: int, channels: Optional[Sequence[str]] = None,
        size: Optional[Tuple[int, int]] = None,
    ) -> Frame:  # fmt: skip
        """Images of one frame, by channel: a dictionary that notebooks show."""
        images = self._images([(trajectory_id, frame)], channels or self.channels, size or self.size)
        return Frame({name: arrays[0] for name, arrays in images.items()})

    def trajectory(self, trajectory_id: str) -> Trajectory:
        """One flight: its frames by number; notebooks show its contact sheet, plan and clip."""
        return Trajectory(self, trajectory_id, self._counts[self._number_of(trajectory_id)])

    def town(self, name: Optional[str] = None) -> Town:
        """A town of a dataset of cosfly, the first by default; notebooks show its plan."""
        table = self.table("trajectories")
        if "town" not in table.columns:
            raise InvalidValue(f"the data in {self.path} state no town that could be drawn")
        for of, trajectory_id in zip(table["town"], table["trajectory_id"]):
            if name in (None, of):
                return Town(self, of, trajectory_id)
        raise NotFound(f"there is no town {name!r}; the towns are {', '.join(sorted(set(table['town'])))}")

    def size_of(self, trajectory_id: str) -> Tuple[int, int]:
        """Width and height of the images of a trajectory as they are stored, pixels."""
        return self._reader.sizes[self._number_of(trajectory_id)]

    def channels_of(self, trajectory_id: str) -> List[str]:
        """Names of the channels that the log of a trajectory has."""
        return self._reader.channels(self._number_of(trajectory_id))

    def check(self) -> None:
        """Raise :class:`cosfly.Error` (``dataset-changed``) where the folder holds another dataset by now."""
        self._reader.check()

    # Samples

    def __len__(self) -> int:
        return len(self._index)

    def __getitem__(self, index: Union[int, np.integer]) -> Sample:
        number = numbered("sample", index, len(self))
        return self._sample(number)

    def __iter__(self) -> Iterator[Sample]:
        return (self[index] for index in range(len(self)))

    def order(self, seed: int = 0, epoch: int = 0, shard: Tuple[int, int] = (0, 1)) -> np.ndarray:
        """Numbers of all samples in the shuffled order of an epoch; of shard (k, n) every n-th from the k-th on.

        The order depends on seed, epoch and the number of samples alone, so ``order(...)[done:]`` goes on where a
        training run stopped. Shards have equal lengths: the last samples are left out where they do not divide.
        """
        first, count = _shard(shard)
        order = np.random.Generator(np.random.PCG64([seed, epoch])).permutation(len(self))
        return order[: len(self) // count * count][first::count]

    def loader(self, batch_size: int = 1, **options: Any) -> "Loader":
        """Shuffled batches, as :class:`cosfly.Loader`."""
        return Loader(self, batch_size, **options)

    # Inside

    @property
    def _reader(self) -> Reader:
        process, reader = self._opened
        if reader is None or process != os.getpid():  # a fork opens its own files
            reader = Reader(os.fspath(self.path))
            if self.identity not in ("", reader.identity):
                raise _cosfly.changed_dataset(os.fspath(self.path), self.identity, reader.identity)
            self._opened = (os.getpid(), reader)
        return reader

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_opened": (-1, None)}

    def _images(
        self, frames: Sequence[Tuple[str, int]], channels: Sequence[str], size: Optional[Tuple[int, int]]
    ) -> Dict[str, List[np.ndarray]]:
        return self._reader.images(self._places(frames), list(channels), size, self.jobs)

    def _places(self, frames: Sequence[Tuple[str, int]]) -> List[Tuple[int, int]]:
        """Numbers of trajectories and frames, which exist."""
        places = []
        for name, frame in frames:
            number, asked = self._number_of(name), _index("frame", frame)
            if not 0 <= asked < self._counts[number]:
                raise OutOfRange(f"frame {asked} of {name!r}, which has the frames 0 to {self._counts[number] - 1}")
            places.append((number, asked))
        return places

    def _number_of(self, trajectory_id: str) -> int:
        number = self._number.get(trajectory_id)
        if number is None:
            near = difflib.get_close_matches(str(trajectory_id), self._number, 3) or list(self._number)[:3]
            raise NotFound(f"{self.path} has no trajectory {trajectory_id!r}; it has {', '.join(near)} ...")
        return number

    def _frames_index(self, columns: Sequence[str]) -> List[Tuple[str, int]]:
        roles = dict(zip(self.table("trajectories")["trajectory_id"], self.table("trajectories")["role"]))
        names = [name for name in self.trajectory_ids if self.role in (None, ROLES[int(roles[name])])]
        frames = dict(zip(self._number, self._counts))
        if columns:
            table = self.table("frames")
            place = {key: row for row, key in enumerate(zip(table["trajectory_id"], table["frame"].tolist()))}
            rows = np.array([place[name, frame] for name in names for frame in range(frames[name])], dtype=int)
            self._columns = {name: _taken(table[name], rows) for name in columns}
        return [(name, frame) for name in names for frame in range(frames[name])]

    def _read_captions(self, language: str) -> Dict[str, Dict[str, str]]:
        table = self.table("captions")
        found: Dict[str, Dict[str, str]] = {}
        styles = table["style"] if "style" in table.columns else [""] * len(table)  # other layouts state none
        for name, of, style, text in zip(table["trajectory_id"], table["language"], styles, table["text"]):
            if of == language:
                found.setdefault(name, {}).setdefault(style, text)
        if not found and self.trajectory_ids:
            languages = ", ".join(sorted({str(of) for of in table["language"]}))
            raise InvalidValue(f"no caption is in {language!r}; the languages are {languages or 'not stated: there are no captions'}")
        return found

    def _sample(self, number: int) -> Sample:
        name, frame = self._index[number]
        images = self._images([(name, frame)], self.channels, self.size) if self.channels else {}
        sample: Sample = {channel: arrays[0] for channel, arrays in images.items()}
        sample.update(trajectory_id=name, frame=frame)
        sample.update({column: values[number] for column, values in self._columns.items()})
        return self._captioned(sample, name)

    def _captioned(self, sample: Sample, name: str) -> Sample:
        if self._captions:
            sample["captions"] = dict(self._captions.get(name, {}))
        return sample

    def __repr__(self) -> str:
        return f"<cosfly.{type(self).__name__} {self.path}: {len(self)} {self._unit} of {len(self.trajectory_ids)} trajectories>"

    def _repr_html_(self) -> str:
        from ._show import dataset_html

        return dataset_html(self)


class Windows(Dataset):
    """Training windows of a dataset, by number: what :meth:`Dataset.windows` gives.

    ``windows[i]`` is a dictionary: the channels with one picture for each frame of the input (``rgb`` is
    (frames, H, W, 3)), ``trajectory_id``, ``start_frame``, ``role`` (``expert`` or ``perturbed``), ``captions`` where they
    were asked for, and the columns of table ``windows`` as arrays of rows: steps are dx, dy, dz (m), dpitch, dyaw, droll
    (degrees); boxes left, top, right, bottom in pixels of the scaled pictures.
    """

    _unit = "windows"

    def __init__(self, dataset: Dataset):
        self.__dict__.update(dataset.__dict__)
        self.dataset = dataset
        self._index = self._windows_index()

    @property
    def _reader(self) -> Reader:
        return self.dataset._reader

    def _images(
        self, frames: Sequence[Tuple[str, int]], channels: Sequence[str], size: Optional[Tuple[int, int]]
    ) -> Dict[str, List[np.ndarray]]:
        return self.dataset._images(frames, channels, size)

    def _windows_index(self) -> List[Tuple[str, int]]:
        table = self.table("windows")
        kept = np.ones(len(table), bool) if self.role is None else table["role"] == ROLES.index(self.role)
        kept = np.flatnonzero(kept)
        names, starts = table["trajectory_id"], table["start_frame"]
        self._columns = {"role": table["role"][kept]}
        for name in WINDOW_LISTS:
            self._columns[name] = _taken(table[name], kept)
        self._columns["image_px"] = dict(zip(self._reader.trajectory_ids, self._reader.sizes))
        return [(names[row], int(starts[row])) for row in kept]

    def _sample(self, number: int) -> Sample:
        name, start = self._index[number]
        rows: Dict[str, np.ndarray] = {
            column: np.asarray(self._columns[column][number]).reshape(-1, width).astype(np.float32)
            for column, width in WINDOW_LISTS.items()
        }
        rows["current_pose_in_world"] = np.asarray(self._columns["current_pose_in_world"][number])
        history = len(rows["input_boxes_px"])
        frames = [(name, start + frame) for frame in range(history)]
        images = self._images(frames, self.channels, self.size) if self.channels else {}
        sample: Sample = {channel: np.stack(them) if isinstance(them, list) else them for channel, them in images.items()}
        if self.size:
            width, height = self._columns["image_px"][name]
            across, down = self.size[0] / width, self.size[1] / height
            rows["input_boxes_px"] = rows["input_boxes_px"] * np.array([across, down, across, down], np.float32)
        sample.update(trajectory_id=name, start_frame=start, role=ROLES[int(self._columns["role"][number])], **rows)
        return self._captioned(sample, name)


class Loader:
    """Shuffled batches of a dataset, deterministic and resumable to the batch.

    Iterating gives the rest of the current epoch; the next iteration gives the next epoch. ``state_dict()`` and
    ``load_state_dict()`` keep the place. Arrays are stacked, other values become lists. ``shard=(rank, world_size)``
    splits every epoch between processes; ``jobs`` of the dataset decode pictures side by side.
    """

    @options()
    def __init__(
        self, dataset: Dataset, batch_size: int = 1, *, seed: int = 0, shuffle: bool = True,
        shard: Tuple[int, int] = (0, 1), drop_last: bool = False,
    ):  # fmt: skip
        self.dataset, self.batch_size = dataset, _whole("batch_size", batch_size, 1)
        self.seed, self.shuffle = _whole("seed", seed, 0), shuffle
        self.shard, self.drop_last = _shard(shard), drop_last
        self.epoch, self.batch = 0, 0

    def _order(self) -> np.ndarray:
        if self.shuffle:
            return self.dataset.order(self.seed, self.epoch, self.shard)
        first, count = self.shard
        return np.arange(len(self.dataset) // count * count)[first::count]

    def __len__(self) -> int:
        samples = len(self.dataset) // self.shard[1]
        return samples // self.batch_size if self.drop_last else -(-samples // self.batch_size)

    def __iter__(self) -> Iterator[Sample]:
        order = self._order()
        while self.batch < len(self):
            numbers = order[self.batch * self.batch_size :][: self.batch_size]
            samples = [self.dataset[number] for number in numbers]
            self.batch += 1
            yield collated(samples)
        self.epoch, self.batch = self.epoch + 1, 0

    def state_dict(self) -> Dict[str, Any]:
        """Place in the data: the next batch of the current epoch, and what its numbers mean."""
        return {"epoch": self.epoch, "batch": self.batch, "seed": self.seed, **self._meaning()}

    def _meaning(self) -> Dict[str, Any]:
        """What the number of a batch means: which samples, in which order, how many at a time."""
        of = self.dataset
        return {
            "samples": len(of), "dataset": of.identity, "split": of.split, "unit": of._unit, "role": of.role,
            "batch_size": self.batch_size, "shuffle": self.shuffle, "shards": self.shard[1],
        }  # fmt: skip

    def load_state_dict(self, state: Dict[str, Any]) -> None:
        """Go on where ``state_dict()`` was taken; dataset, batch size and number of shards must be the same."""
        mine = self._meaning()
        other = [name for name in mine if name in state and state[name] != mine[name]]
        if other:
            told = ", ".join(f"{name} {state[name]!r}, here {mine[name]!r}" for name in other)
            raise InvalidValue(f"the state is of other batches: {told}; make the loader as it was, or begin anew")
        if "dataset" not in state:
            warnings.warn("the state was taken by an older cosfly and does not say of which dataset it is", stacklevel=2)
        epoch, batch, seed = (_whole(name, state[name], 0) for name in ("epoch", "batch", "seed"))
        if batch > len(self):
            raise InvalidValue(f"the state is at batch {batch}; an epoch has {len(self)} batches")
        self.epoch, self.batch, self.seed = epoch, batch, seed


def numbered(what: str, index: Any, count: int) -> int:
    """Place of an item by its number, as lists have it: whole numbers, from the end where negative."""
    number = _index(what, index)
    if not -count <= number < count:
        raise OutOfRange(f"{what} {number} of {count}")
    return number % count


def _index(what: str, index: Any) -> int:
    try:
        return operator.index(index)
    except TypeError:
        raise WrongType(f"a {what} is chosen by a whole number, not by {index!r} ({type(index).__name__})") from None


def _shard(shard: Tuple[int, int]) -> Tuple[int, int]:
    """Number of a shard and of all shards."""
    first, count = (_whole("shard", part, 0) for part in shard)
    if not first < count:
        raise InvalidValue(f"the shard is {shard}; it must be (k, n) with 0 <= k < n")
    return first, count


def _whole(name: str, value: Any, least: int) -> int:
    """A whole number that is at least ``least``."""
    try:
        number = operator.index(value)
    except TypeError:
        raise WrongType(f"`{name}` is {value!r}; it must be a whole number") from None
    if number < least:
        raise InvalidValue(f"`{name}` is {number}; it must be at least {least}")
    return number


def collated(samples: Sequence[Sample]) -> Sample:
    """One batch of samples: arrays and numbers stacked, other values in lists."""
    batch: Sample = {}
    for name, first in samples[0].items():
        values = [sample[name] for sample in samples]
        stacks = isinstance(first, (np.ndarray, np.generic, int, float))
        same = stacks and all(np.shape(value) == np.shape(first) for value in values)
        batch[name] = np.stack(values) if same else values
    return batch


def _taken(values: Any, rows: np.ndarray) -> Any:
    return values[rows] if isinstance(values, np.ndarray) else [values[row] for row in rows]
