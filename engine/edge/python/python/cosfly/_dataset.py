"""Samples of a dataset: pictures from the logs, and rows of its tables, as numpy arrays."""

from __future__ import annotations

import difflib
import fnmatch
import hashlib
import operator
import os
import warnings
from pathlib import Path
from typing import Any, Container, Dict, Iterable, Iterator, Mapping, Sequence

import numpy as np

from . import _cosfly
from ._calls import PathLike
from ._cosfly import Reader, Table
from ._errors import InvalidValue, NotFound, OutOfRange, WrongType, names_of, options, path_of, size_of
from ._show import Frame, Town, Trajectory

CHANNELS = ("rgb", "depth")
ROLES = ("expert", "perturbed")
ANCHORS = ("input", "expert")
DIFFICULTIES = ("easy", "medium", "hard")
SMALLEST_TARGET_PX = 8
WINDOW_LISTS = {
    # Column of table `windows`: numbers per row of the array. Other layouts may lack those of the expert.
    "current_pose_in_world": 6,
    "input_steps_in_world": 6,
    "input_steps_in_body": 6,
    "correction_in_world": 6,
    "correction_in_body": 6,
    "waypoint_deltas_in_world": 6,
    "waypoint_deltas_in_body": 6,
    "expert_steps_in_world": 6,
    "expert_steps_in_body": 6,
    "input_boxes_px": 4,
    "expert_boxes_px": 4,
}

Sample = Dict[str, Any]


class Dataset:
    """Frames of a dataset, by number; :meth:`windows` gives its training windows.

    ``path`` is a dataset of cosfly, a folder of the published v7 layout, or one of LeRobot (with pictures, not videos; of
    ``cosfly export`` or of others). ``dataset[i]`` is a dictionary. Pictures are read at random, decoded and scaled in Rust:

    * ``rgb``: uint8, (H, W, 3);
    * ``depth``: float32 metres, planar, of wide lenses along the rays; infinite for the sky;
    * ``semantic``: uint8, CARLA's labels; ``instance``: uint32;
    * ``trajectory_id``, ``frame``, and each of ``columns`` of table ``frames``; boxes are in pixels of the pictures that the
      sample has, scaled with ``size``, those of :meth:`table` in pixels of the stored pictures;
    * ``captions`` where ``captions`` is a language: the text of each style, by its name (``""`` in other layouts).

    Foreign layouts give the tables ``trajectories``, ``frames``, ``captions`` and ``windows`` (of the default shape) with
    the columns whose values they hold: v7 has ``rgb``, ``depth``, ``semantic`` and ``instance``, LeRobot ``rgb``, and
    ``depth`` where it is a feature in metres, as of ``cosfly export --depth`` (the sky is its greatest depth).

    Scaled colours are the mean over each pixel's area; other channels are sampled at the middle of each pixel. Flow and
    disparity are lengths in pixels of the sample's pictures, as boxes are. Without
    ``size`` all channels are bit for bit what the files hold. The object is map-style: ``torch.utils.data.DataLoader``
    takes it as it is, workers included (each process opens its own files).

    The object keeps the ``identity`` of the dataset that was opened. Where the folder is made anew meanwhile, pictures and
    tables that are asked for later raise :class:`cosfly.Error` (``dataset-changed``), in worker processes, too: open it again.

    ``channels`` are ``rgb`` and ``depth`` by default; those that are named must be in the first flight of each camera. One name
    alone needs no list.
    ``split`` is ``train``, ``val``, ``test`` or None for all; ``role`` is ``expert``, ``perturbed`` or None for both;
    ``trajectories`` are ids, or patterns such as ``"expert-*"`` (all flights of the stage ``expert``); ``size`` is (width,
    height); ``jobs`` threads decode the pictures of one call, of :meth:`batch` and of a :class:`Loader`.
    """

    _unit = "frames"
    identity: str = ""
    """Digest that tells this dataset from others: of cosfly's own, the hash of ``files.parquet``."""

    @options(windows="the method `windows()` of the dataset")
    def __init__(
        self,
        path: PathLike,
        *,
        split: str | None = None,
        role: str | None = None,
        trajectories: str | Sequence[str] | None = None,
        channels: str | Sequence[str] | None = None,
        size: tuple[int, int] | None = None,
        columns: str | Sequence[str] = (),
        captions: str | None = None,
        jobs: int = 1,
    ):
        self.path = Path(path_of(path))
        self.split, self.role = split, role
        self.channels, self.size = CHANNELS if channels is None else names_of("channels", channels), None if size is None else size_of(size)
        self._opened: tuple[int, Reader | None] = (-1, None)
        self.jobs = min(_whole("jobs", jobs, 1), 1024)
        if split not in (None, "train", "val", "test"):
            raise InvalidValue(f"the split is {split!r}; splits are 'train', 'val' and 'test'")
        if role not in (None, *ROLES):
            raise InvalidValue(f"the role is {role!r}; roles are 'expert' and 'perturbed'")
        self.identity = self._reader.identity
        self._reader.images([], list(self.channels), self.size, self.jobs)  # refuses names and sizes before the first sample
        ids = self._reader.trajectory_ids
        if split and not any(self._reader.splits):
            raise InvalidValue(f"the data in {self.path} state no splits; leave out `split`")
        self._number = {name: number for number, name in enumerate(ids)}
        self._counts = self._reader.frames
        chosen = self._chosen(trajectories)
        splits = zip(ids, self._reader.splits)
        self.trajectory_ids: list[str] = [name for name, of in splits if split in (None, of) and name in chosen]
        """Ids of the trajectories of the split, and of ``trajectories``."""
        self._columns: dict[str, Any] = {}
        self._numbers: dict[tuple[str, int], int] | None = None
        self._index = self._frames_index(names_of("columns", columns))
        self._captions = self._read_captions(captions) if captions else {}
        for name in self._one_of_each_camera() if channels is not None else ():
            has = self.channels_of(name)
            self._reader.images(self._places([(name, 0)]), [channel for channel in self.channels if channel not in has])

    def _chosen(self, trajectories: str | Sequence[str] | None) -> Container[str]:
        """Ids of the trajectories that are asked for."""
        return _matching(trajectories, self._number)

    def windows(self, anchor: str = "input") -> "Windows":
        """The training windows of the dataset, with the same split, role, channels, size and captions.

        ``waypoint_deltas_in_*`` lead from the last pose of the input to the expert's next one, and on along the expert. With
        ``anchor="expert"`` they begin at the expert's pose of that frame, as in the paper's comparison.
        """
        return Windows(self, anchor)

    # Tables and frames

    def table(self, name: str) -> Table:
        """A table of the split: ``table("trajectories")["town"]``, or ``pyarrow.table(dataset.table("frames"))``."""
        return self._reader.table(name, self.split)

    def frame(
        self, trajectory_id: str, frame: int, channels: str | Sequence[str] | None = None,
        size: tuple[int, int] | None = None,
    ) -> Frame:  # fmt: skip
        """Images of one frame, by channel: a dictionary that notebooks show."""
        images = self._images([(trajectory_id, frame)], names_of("channels", channels or self.channels), size_of(size) if size else self.size)
        return Frame({name: arrays[0] for name, arrays in images.items()})

    def trajectory(self, trajectory_id: str) -> Trajectory:
        """One flight: its frames by number; notebooks show its contact sheet, plan and clip."""
        return Trajectory(self, trajectory_id, self._counts[self._number_of(trajectory_id)])

    def town(self, name: str | None = None) -> Town:
        """A town of a dataset of cosfly, the first by default; notebooks show its plan."""
        table = self.table("trajectories")
        if "town" not in table.columns:
            raise InvalidValue(f"the data in {self.path} state no town that could be drawn")
        for of, trajectory_id in zip(table["town"], table["trajectory_id"]):
            if name in (None, of):
                return Town(self, of, trajectory_id)
        raise NotFound(f"there is no town {name!r}; the towns are {', '.join(sorted(set(table['town'])))}")

    def size_of(self, trajectory_id: str) -> tuple[int, int]:
        """Width and height of the images of a trajectory as they are stored, pixels."""
        return self._reader.sizes[self._number_of(trajectory_id)]

    def channels_of(self, trajectory_id: str) -> list[str]:
        """Names of the channels that the log of a trajectory has."""
        return self._reader.channels(self._number_of(trajectory_id))

    def check(self) -> None:
        """Raise :class:`cosfly.Error` (``dataset-changed``) where the folder holds another dataset by now."""
        self._reader.check()

    # Samples

    def __len__(self) -> int:
        return len(self._index)

    def __getitem__(self, index: int | np.integer) -> Sample:
        return self._samples([numbered("sample", index, len(self))])[0]

    def batch(self, numbers: Sequence[int | np.integer]) -> Sample:
        """Some samples as one batch, as a :class:`Loader` gives it; ``jobs`` threads read and decode all of its pictures."""
        if not len(numbers):
            raise InvalidValue("a batch without numbers has no samples; give one number or more")
        return collated(self._samples([numbered("sample", number, len(self)) for number in numbers]))

    def number_of(self, trajectory_id: str, frame: int) -> int:
        """Number of the sample of a frame; of windows, that of the window that begins with the frame."""
        if self._numbers is None:
            self._numbers = {place: number for number, place in enumerate(self._index)}
        number = self._numbers.get((trajectory_id, _index("frame", frame)))
        if number is None:
            self._number_of(trajectory_id)
            frames = [at for name, at in self._index if name == trajectory_id]
            there = f"its samples begin with {', '.join(map(str, frames[:4]))} ..." if frames else "it is not among these samples"
            raise NotFound(f"{trajectory_id!r} has no sample of frame {frame}; {there}")
        return number

    def __iter__(self) -> Iterator[Sample]:
        return (self[index] for index in range(len(self)))

    def order(self, seed: int = 0, epoch: int = 0, shard: tuple[int, int] = (0, 1)) -> np.ndarray:
        """Numbers of all samples in the shuffled order of an epoch; of shard (k, n) every n-th from the k-th on.

        The order depends on seed, epoch and the number of samples alone, so ``order(...)[done:]`` goes on where a
        training run stopped. Shards have equal lengths: the last samples are left out where they do not divide.
        """
        first, count = _shard(shard)
        seed, epoch = _whole("seed", seed, 0), _whole("epoch", epoch, 0)
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

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": (-1, None)}

    def _images(
        self, frames: Sequence[tuple[str, int]], channels: Sequence[str], size: tuple[int, int] | None
    ) -> dict[str, list[np.ndarray]]:
        return self._reader.images(self._places(frames), list(channels), size, self.jobs)

    def _places(self, frames: Sequence[tuple[str, int]]) -> list[tuple[int, int]]:
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

    def _one_of_each_camera(self) -> list[str]:
        """First flight of each camera among the samples: films of one camera have the same channels."""
        table = self.table("trajectories")
        cameras = table["camera_name"] if "camera_name" in table.columns else [None] * len(table)
        camera_of = dict(zip(table["trajectory_id"], cameras))
        first = {camera_of[name]: name for name in dict.fromkeys(name for name, _ in reversed(self._index))}
        return sorted(first.values())

    def _frames_index(self, columns: Sequence[str]) -> list[tuple[str, int]]:
        roles = dict(zip(self.table("trajectories")["trajectory_id"], self.table("trajectories")["role"]))
        names = [name for name in self.trajectory_ids if self.role in (None, ROLES[int(roles[name])])]
        frames = dict(zip(self._number, self._counts))
        if columns:
            table = self.table("frames")
            place = {key: row for row, key in enumerate(zip(table["trajectory_id"], table["frame"].tolist()))}
            rows = np.array([place[name, frame] for name in names for frame in range(frames[name])], dtype=int)
            self._columns = {name: _taken(table[name], rows) for name in columns}
        return [(name, frame) for name in names for frame in range(frames[name])]

    def _read_captions(self, language: str) -> dict[str, dict[str, str]]:
        table = self.table("captions")
        found: dict[str, dict[str, str]] = {}
        styles = table["style"] if "style" in table.columns else [""] * len(table)  # other layouts state none
        for name, of, style, text in zip(table["trajectory_id"], table["language"], styles, table["text"]):
            if of == language:
                found.setdefault(name, {}).setdefault(style, text)
        if not found and self.trajectory_ids:
            languages = ", ".join(sorted({str(of) for of in table["language"]}))
            raise InvalidValue(f"no caption is in {language!r}; the languages are {languages or 'not stated: there are no captions'}")
        return found

    def _samples(self, numbers: Sequence[int]) -> list[Sample]:
        """Some samples; their pictures are read with one call."""
        wanted = [self._frames_of_sample(number) for number in numbers]
        frames = [frame for of in wanted for frame in of]
        images = self._images(frames, self.channels, self.size) if self.channels else {}
        samples, first = [], 0
        for number, of in zip(numbers, wanted):
            pictures = {channel: arrays[first : first + len(of)] for channel, arrays in images.items()}
            samples.append(self._captioned(self._labelled(number, pictures), self._index[number][0]))
            first += len(of)
        return samples

    def _frames_of_sample(self, number: int) -> list[tuple[str, int]]:
        return [self._index[number]]

    def _rows_of(self, frames: Sequence[tuple[str, int]]) -> list[int]:
        raise InvalidValue("`rows` are places in the arrays of a pack: ask the windows of a `cosfly.Pack`; `cosfly.pack` makes one")

    def _labelled(self, number: int, pictures: dict[str, Any]) -> Sample:
        name, frame = self._index[number]
        sample: Sample = {channel: arrays[0] for channel, arrays in pictures.items()}
        sample.update(trajectory_id=name, frame=frame)
        for column, values in self._columns.items():
            is_scaled = self.size and column.endswith("_box_px") and values[number] is not None
            sample[column] = self._scaled(name, values[number]) if is_scaled else values[number]
        return sample

    def _scaled(self, name: str, edges_px: Any) -> np.ndarray:
        """Boxes of stored pictures in pixels of the samples' pictures."""
        width, height = self._reader.sizes[self._number_of(name)]
        across, down = (self.size or (width, height))[0] / width, (self.size or (width, height))[1] / height
        return np.asarray(edges_px, np.float32) * np.array([across, down, across, down], np.float32)

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
    (frames, H, W, 3)), ``trajectory_id``, ``start_frame``, ``role`` (``expert`` or ``perturbed``), ``split``, ``town``,
    ``difficulty`` (``easy``, ``medium``, ``hard``), ``captions`` where they were asked for, and the columns of table
    ``windows`` as arrays of rows: steps are dx, dy, dz (m), dpitch, dyaw, droll (degrees); boxes left, top, right, bottom in
    pixels of the scaled pictures. Other layouts have what their data state.
    """

    _unit = "windows"

    def __init__(self, dataset: Dataset, anchor: str = "input"):
        if anchor not in ANCHORS:
            raise InvalidValue(f"the anchor is {anchor!r}; anchors are 'input' and 'expert'")
        self.__dict__.update(dataset.__dict__)
        self.dataset, self.anchor, self._numbers = dataset, anchor, None
        self._index = self._windows_index()
        if self.size:
            warn_of_small_targets(self, ((name, self._arrays["input_boxes_px"][n][-1]) for n, (name, _) in enumerate(self._index)))

    def array(self, column: str) -> np.ndarray:
        """A column of all windows as one array, such as ``waypoint_deltas_in_body``: (windows, 5, 6)."""
        if column not in self._arrays:
            raise NotFound(f"there is no column {column!r}; columns are {', '.join(self._arrays)}")
        rows = self._arrays[column]
        if self.size and column.endswith("_boxes_px"):
            rows = [self._scaled(name, boxes) for (name, _), boxes in zip(self._index, rows)]
        return np.stack(rows) if len(rows) else np.empty((0, *self._shape_of(column)), np.float32)

    def _shape_of(self, column: str) -> tuple[int, ...]:
        """Shape of a column of one window, by any window of the data where none is chosen."""
        width, rows = WINDOW_LISTS[column], self._reader.table("windows", None)[column]
        numbers = len(rows[0]) if len(rows) else 0
        return (width,) if column == "current_pose_in_world" else (numbers // width, width)

    @property
    def rows(self) -> np.ndarray:
        """Places of each window's pictures in the arrays of a pack, (windows, frames of the input)."""
        return np.array([self.dataset._rows_of(self._frames_of_sample(number)) for number in range(len(self))], dtype=np.int64)

    @property
    def _reader(self) -> Reader:
        return self.dataset._reader

    def _images(
        self, frames: Sequence[tuple[str, int]], channels: Sequence[str], size: tuple[int, int] | None
    ) -> dict[str, list[np.ndarray]]:
        return self.dataset._images(frames, channels, size)

    def _windows_index(self) -> list[tuple[str, int]]:
        table = self.table("windows")
        of_dataset = set(self.trajectory_ids)
        kept = np.ones(len(table), bool) if self.role is None else table["role"] == ROLES.index(self.role)
        kept &= np.array([name in of_dataset for name in table["trajectory_id"]], bool)
        kept = np.flatnonzero(kept)
        names, starts = table["trajectory_id"], table["start_frame"]
        has = set(table.columns)
        self._arrays: dict[str, list[np.ndarray]] = {
            name: [np.asarray(row).reshape(-1, width).astype(np.float32) for row in _taken(table[name], kept)]
            for name, width in WINDOW_LISTS.items()
            if name in has and name != "current_pose_in_world"
        }
        self._arrays["current_pose_in_world"] = [np.asarray(row) for row in _taken(table["current_pose_in_world"], kept)]
        if self.anchor == "expert":
            if "expert_steps_in_body" not in has:
                raise InvalidValue(f"the windows of {self.path} do not hold the expert's steps; the anchor is 'input'")
            for axes in ("world", "body"):
                steps, boxes = self._arrays[f"expert_steps_in_{axes}"], self._arrays["input_boxes_px"]
                self._arrays[f"waypoint_deltas_in_{axes}"] = [it[len(seen) - 1 :] for it, seen in zip(steps, boxes)]
        self._columns = {"role": [ROLES[int(role)] for role in table["role"][kept]]}
        if any(self._reader.splits):
            splits = dict(zip(self._reader.trajectory_ids, self._reader.splits))
            self._columns["split"] = [splits[names[row]] for row in kept]
        trajectories = self.table("trajectories")
        if "town" in trajectories.columns:
            towns = dict(zip(trajectories["trajectory_id"], trajectories["town"]))
            self._columns["town"] = [towns[names[row]] for row in kept]
        if "difficulty" in has:
            self._columns["difficulty"] = [DIFFICULTIES[int(number)] for number in table["difficulty"][kept]]
        return [(names[row], int(starts[row])) for row in kept]

    def _frames_of_sample(self, number: int) -> list[tuple[str, int]]:
        name, start = self._index[number]
        return [(name, start + frame) for frame in range(len(self._arrays["input_boxes_px"][number]))]

    def _labelled(self, number: int, pictures: dict[str, Any]) -> Sample:
        name, start = self._index[number]
        sample: Sample = {channel: np.stack(them) if isinstance(them, list) else them for channel, them in pictures.items()}
        sample.update(trajectory_id=name, start_frame=start)
        sample.update({column: values[number] for column, values in self._columns.items()})
        for column, rows in self._arrays.items():
            is_scaled = self.size and column.endswith("_boxes_px")
            sample[column] = self._scaled(name, rows[number]) if is_scaled else rows[number]
        return sample


def warn_of_small_targets(dataset: Dataset, boxes: Iterable[tuple[str, Any]]) -> None:
    """Warns where the target is small at the dataset's size; ``boxes`` are trajectories and edges in stored pictures."""
    scaled = (dataset._scaled(name, edges) for name, edges in boxes if edges is not None)
    heights = [edges[3] - edges[1] for edges in scaled if edges[3] > edges[1]]
    if heights and (median := float(np.median(heights))) < SMALLEST_TARGET_PX:
        width, height = dataset.size or (0, 0)
        warnings.warn(
            f"the target is {median:.1f} pixels high at {width} x {height}, in the median where it is visible; below {SMALLEST_TARGET_PX} "
            "little can be learnt about it from pictures: choose a larger `size`, or a smaller `fov_deg` in the recipe",
            stacklevel=4,
        )


class Loader:
    """Shuffled batches of a dataset, deterministic and resumable to the batch.

    Iterating gives the rest of the current epoch; the next iteration gives the next epoch. ``state_dict()`` and
    ``load_state_dict()`` keep the place. Arrays are stacked, other values become lists. ``shard=(rank, world_size)``
    splits every epoch between processes; ``jobs`` of the dataset decode pictures side by side.
    """

    @options()
    def __init__(
        self, dataset: Dataset, batch_size: int = 1, *, seed: int = 0, shuffle: bool = True,
        shard: tuple[int, int] = (0, 1), drop_last: bool = False,
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
            batch = self.dataset.batch(numbers)
            self.batch += 1
            yield batch
        self.epoch, self.batch = self.epoch + 1, 0

    def state_dict(self) -> dict[str, Any]:
        """Place in the data: the next batch of the current epoch, and what its numbers mean."""
        return {"epoch": self.epoch, "batch": self.batch, "seed": self.seed, **self._meaning()}

    def _meaning(self) -> dict[str, Any]:
        """What the number of a batch means: which samples, in which order, how many at a time."""
        of = self.dataset
        flights = hashlib.sha256("\n".join(of.trajectory_ids).encode()).hexdigest()[:16]
        return {
            "samples": len(of), "dataset": of.identity, "split": of.split, "unit": of._unit, "role": of.role,
            "flights": flights, "anchor": getattr(of, "anchor", None),
            "batch_size": self.batch_size, "shuffle": self.shuffle, "shards": self.shard[1],
        }  # fmt: skip

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Go on where ``state_dict()`` was taken; dataset, batch size and number of shards must be the same."""
        if not isinstance(state, Mapping):
            raise WrongType(f"the state is {state!r:.60} ({type(state).__name__}); give what `state_dict()` gave")
        mine = self._meaning()
        absent = [name for name in ("epoch", "batch", "seed") if name not in state]
        if absent:
            raise InvalidValue(f"the state has no {' and no '.join(map(repr, absent))}; give what `state_dict()` gave")
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


def _shard(shard: tuple[int, int]) -> tuple[int, int]:
    """Number of a shard and of all shards."""
    try:
        first, count = shard
    except (TypeError, ValueError):
        raise WrongType(f"`shard` is {shard!r:.60}; it is (k, n), whole numbers with 0 <= k < n") from None
    first, count = _whole("shard", first, 0), _whole("shard", count, 0)
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


def _matching(trajectories: str | Sequence[str] | None, names: Iterable[str]) -> Container[str]:
    """Names that are given, or match a given pattern."""
    known = dict.fromkeys(names)
    if trajectories is None:
        return known
    given = names_of("trajectories", trajectories)
    found = {name for name in given if name in known}
    for pattern in given:
        more = fnmatch.filter(known, pattern) if pattern not in found and any(sign in pattern for sign in "*?[") else []
        if pattern not in found and not more:
            near = difflib.get_close_matches(pattern, known, 3) or list(known)[:3]
            raise NotFound(f"no trajectory is called {pattern!r}, and none matches it; there are {', '.join(near)} ...")
        found.update(more)
    return found
