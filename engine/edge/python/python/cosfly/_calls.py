"""The commands of cosfly as functions with typed results.

A function writes its options as arguments of the command and reads the command's ``--json``. The command line checks each option and says
what is allowed; bound one by one, the 65 options of these functions would be declared, converted and checked a second time, in Rust.
Both sides are of one build, so a result takes each field of the JSON and no other: one that has a new name in Rust fails the first call."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Mapping, Optional, Sequence, Tuple, Union

from . import _cosfly, _toml
from ._errors import InvalidValue, WrongType, names_of, options, path_of
from ._show import Bars

if TYPE_CHECKING:
    from ._dataset import Dataset

PathLike = Union[str, "os.PathLike[str]"]
Recipe = Union[PathLike, Mapping[str, Any]]
"""The path of a recipe (or of a folder with a ``recipe.toml``), or the recipe itself as a dictionary."""
Settings = Optional[Mapping[str, Any]]
"""Changes to a recipe: ``{"stages.walkers.count": 8}``."""
Option = Union[None, bool, int, float, str, PathLike, Sequence[str]]
"""Value of an option of a format."""
Progress = Union[bool, Callable[[Dict[str, Tuple[int, int]]], None]]
"""True for bars (terminal or notebook), False for none, or a function that gets {name of the work: (done, all)}."""


@dataclass(frozen=True)
class RunStage:
    """A stage of a finished run."""

    stage: str
    items: int
    cached: int
    ran: int
    reused: int
    failed: int
    skipped: int
    unfinished: int
    not_needed: int
    """Items that were not made: everything that is made of them is finished."""
    digest: str
    """Digest over the outputs of all items: equal exactly when all bytes are equal."""


@dataclass(frozen=True)
class RunResult:
    """Result of :func:`run`."""

    recipe: str
    outcome: str
    """``complete``, ``failed`` or ``stopped``; finished items are kept in the store in any case."""
    stages: list[RunStage]
    rejected: list[dict[str, str]]
    """Items without a usable result: stage, item, reason."""
    out: Path | None
    """Folder of the dataset; None unless the run is complete."""
    version: str | None
    """Digest of the dataset."""
    files: int | None
    bytes: int | None
    seconds: float
    """Time of the run by the clock."""
    core_seconds: float | None
    """Processor time of all threads; None where nothing was left to do or the system does not tell."""
    messages: list[str] = field(repr=False)
    """Warnings and failures, as the command line prints them."""

    @property
    def frames(self) -> int:
        """Frames of the dataset."""
        return len(self.dataset(channels=()))

    def dataset(self, **options: Any) -> "Dataset":
        """The dataset, as :class:`cosfly.Dataset` with the given options."""
        from ._dataset import Dataset

        if self.out is None:
            raise InvalidValue(f"the run is {self.outcome}, so there is no dataset; `messages` says why")
        return Dataset(self.out, **options)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{s.stage}</td><td>{s.items}</td><td>{s.cached}</td><td>{s.ran}</td><td>{s.failed}</td></tr>"
            for s in self.stages
        )
        heads = "<tr><th>stage</th><th>items</th><th>cached</th><th>made</th><th>failed</th></tr>"
        return f"<p>{self.recipe}: {self.outcome}, {self.out or ''}</p><table>{heads}{rows}</table>"


@dataclass(frozen=True)
class PlanStage:
    """A stage of a plan."""

    stage: str
    uses: str
    items: int
    cached: int
    to_run: int
    not_needed: int
    """Items that are not in the store, and that nothing needs."""
    made_again: int
    """Finished items whose intermediate files were removed, and that may be made again for a reader."""
    predicted_core_s: float | None
    """Time of the items to run on one core each, seconds; None where none was measured in this store."""
    predicted_bytes: int
    predicted_files: int
    """Files that the items to run are expected to write."""
    reasons: list[dict[str, Any]]
    """Why items would run, with their number."""
    asks: dict[str, Any] | None
    """Questions to a service outside, their tokens and price, where the stage has any."""


@dataclass(frozen=True)
class PlanResult:
    """Result of :func:`plan`."""

    to_run: int
    predicted_core_s: float
    """Time of everything that would run on one core, seconds, as far as it was measured in this store."""
    all_measured: bool
    predicted_bytes: int
    predicted_files: int
    """Files that the run is expected to write."""
    predicted_price: float | None
    """Price of ``predicted_core_s`` where a price of core-hours was given."""
    stages: list[PlanStage]


@dataclass(frozen=True)
class WhyResult:
    """Result of :func:`why`."""

    task: str
    cached: bool
    needed: bool
    """False where everything that is made of the result is finished."""
    chain: list[dict[str, Any]]
    """Tasks from the asked one to the root cause, each with its changes."""


@dataclass(frozen=True)
class VerifyResult:
    """Result of :func:`verify`."""

    sound: bool
    """Whether nothing wrong was found."""
    found: int
    findings: list[str]
    files: int
    bytes: int
    flights: int
    flights_of_dataset: int
    sample: int | None
    """Number of flights in the sample, where only a sample was checked in full."""
    resumed: int
    """Flights that an earlier check had found sound."""
    frames: int
    target_boxes: int
    visibility_labels: int
    """Frames whose visible shares by rays and by pixels were compared."""
    visibility_gaps: int
    """Frames in which they differ by more than 5 points."""
    regenerated: str | None
    regenerated_wrong: int
    dataset: str
    """Identity of the dataset that was checked, as :attr:`cosfly.Dataset.identity`."""
    flights_by_mesh: int
    """Flights that were held against ``mesh``."""

    def __bool__(self) -> bool:
        return self.sound


@dataclass(frozen=True)
class DoctorResult:
    """Result of :func:`doctor`."""

    well: bool
    """No damage, no more imperfect episodes than allowed, and all quotas met."""
    report: dict[str, Any]
    """All findings, as ``cosfly doctor --json`` writes them."""

    def __bool__(self) -> bool:
        return self.well


@dataclass(frozen=True)
class EvaluateResult:
    """Result of :func:`evaluate`."""

    report: dict[str, Any]
    """Scores, intervals and baselines, as in report.json."""
    folder: Path
    """Folder with report.md, report.json and errors.svg."""
    complete: bool
    """Whether all rows could be scored and every window, or frame, has a prediction. If not, the scores are of a part."""

    def _repr_markdown_(self) -> str:
        return (self.folder / "report.md").read_text(encoding="utf-8")


@dataclass(frozen=True)
class PreviewResult:
    """Result of :func:`preview`."""

    trajectory_id: str
    sheet: Path
    """Contact sheet: colours, depth, labels, the target enlarged (PNG)."""
    clip: Path
    """Animated clip (GIF)."""
    plan: Path
    """Town, walk, flights coloured by visibility (PNG)."""

    def _repr_html_(self) -> str:
        from ._show import image_html

        return image_html(self.sheet) + image_html(self.plan) + image_html(self.clip)


@dataclass(frozen=True)
class ExportResult:
    """Result of :func:`export`."""

    out: Path
    format: str
    files: int
    bytes: int
    remarks: list[str]


@options(start="`template`")
def init(folder: PathLike = "town", template: str | None = None) -> Path:
    """Write a folder to begin with: a recipe, its town, a page. ``template`` is ``town`` or ``small``."""
    _call(["init", path_of(folder)] + (["--template", template] if template else []), b"", False)
    return Path(folder)


@options()
def run(
    recipe: Recipe,
    *,
    set: Settings = None,
    out: PathLike | None = None,
    store: PathLike | None = None,
    stage: str | None = None,
    jobs: int | None = None,
    progress: Progress = True,
) -> RunResult:
    """Make everything that a recipe describes, or only ``stage`` and what it needs. Finished items are never made again, and Ctrl-C keeps them.

    Raises :class:`cosfly.Error` where the recipe is wrong. Items that fail do not raise: ``outcome`` is then ``failed``.
    """
    given = _options(out=out, store=store, stage=stage, jobs=jobs)
    _, text, messages = _with_recipe(["run", "--json"], recipe, set, given, progress)
    found = json.loads(text)
    stages = [RunStage(**stage) for stage in found["stages"]]
    folder = Path(found["out"]) if found["out"] else None
    return RunResult(**{**found, "stages": stages, "out": folder, "messages": messages})


@options()
def plan(recipe: Recipe, *, set: Settings = None, store: PathLike | None = None, price: float | None = None) -> PlanResult:
    """What :func:`run` would do, and why. ``price`` is that of a core-hour, in any currency."""
    _, text, _ = _with_recipe(["plan", "--json"], recipe, set, _options(store=store, price=price), False)
    found = json.loads(text)
    stages = [PlanStage(**stage) for stage in found["stages"]]
    return PlanResult(**{**found, "stages": stages})


@options()
def why(recipe: Recipe, subject: str, *, set: Settings = None, store: PathLike | None = None) -> WhyResult:
    """Which field or input changed since a stage or an item (``expert/p00003``) was last made."""
    _, text, _ = _with_recipe(["why", "--json"], recipe, set, _options(store=store), False, [subject])
    return WhyResult(**json.loads(text))


@options()
def verify(
    dataset: PathLike,
    *,
    sample: int | None = None,
    resume: PathLike | None = None,
    jobs: int | None = None,
    regenerate: int | None = None,
    recipe: PathLike | None = None,
    set: Settings = None,
    mesh: PathLike | None = None,
    mesh_set: Settings = None,
    mesh_town: str | None = None,
    store: PathLike | None = None,
    progress: Progress = True,
) -> VerifyResult:
    """Check a finished dataset: hashes, counts, schemas, reprojection, actions; ``regenerate`` makes flights again.

    ``sample`` flights are checked in full instead of all; ``resume`` is a file of notes with which an interrupted check
    goes on. ``mesh`` is the scan that was flown in: flights keep their clearance from its triangles. ``mesh_set`` are its
    keys as in a recipe, such as ``{"up_axis": "z"}``, ``mesh_town`` its town where the dataset has several.
    """
    given = _options(sample=sample, resume=resume, jobs=jobs, regenerate=regenerate, recipe=recipe, store=store)
    arguments = ["verify", path_of(dataset), "--json", *given, *_settings(set), *_mesh(mesh, mesh_set, mesh_town)]
    _, text, _ = _call(arguments, b"", progress)
    return VerifyResult(**json.loads(text))


@options(imperfect="`imperfect_share`, 0 to 1")
def doctor(
    data: PathLike,
    *,
    imperfect_share: float = 0.05,
    quotas: str | Sequence[str] = (),
    texts: PathLike | None = None,
    mesh: PathLike | None = None,
    mesh_set: Settings = None,
    mesh_town: str | None = None,
    jobs: int | None = None,
    progress: Progress = True,
) -> DoctorResult:
    """Examine anyone's data (cosfly, v7, LeRobot): leaks, signs, units, shifts, frozen frames, limits.

    ``imperfect_share`` is the share of imperfect episodes that does no harm, 0 to 1; a quota is like ``"0.2:2-4"``.
    ``texts`` are judged in the place of the data's own: lines of JSON with trajectory_id, language and text. ``mesh`` to
    ``mesh_town`` are those of :func:`verify`.
    """
    arguments = ["doctor", path_of(data), "--json", *_mesh(mesh, mesh_set, mesh_town)]
    arguments += _options(imperfect_share=imperfect_share, quota=names_of("quotas", quotas), texts=texts, jobs=jobs)
    code, text, _ = _call(arguments, b"", progress)
    return DoctorResult(code == 0, json.loads(text))


@options(split="`splits`")
def evaluate(
    dataset: PathLike,
    predictions: PathLike | None = None,
    *,
    out: PathLike | None = None,
    kind: str | None = None,
    splits: str | Sequence[str] = (),
    cameras: str | Sequence[str] = (),
    frame: str | None = None,
    origin: str | None = None,
    anchor: str | None = None,
    input: str | None = None,
    history: int | None = None,
    horizon: int | None = None,
    stride: int | None = None,
    missing_as_zero: bool = False,
    resamples: int | None = None,
    seed: int | None = None,
    every: int | None = None,
    depth_per_metre: float | None = None,
    max_depth_m: float | None = None,
    categories: int | Sequence[int] = (),
    images: PathLike | None = None,
    sequences: PathLike | None = None,
    jobs: int | None = None,
) -> EvaluateResult:
    """Score predictions on a dataset, beside baselines; without predictions the baselines alone. The command is ``cosfly eval``.

    ``frame`` (``world`` or ``body``) gives the axes of increments, ``origin`` (``previous`` or ``current``) the pose that
    each starts from, ``anchor`` (``input`` or ``expert``) that of the first. ``history``, ``horizon`` and ``stride`` are
    numbers of frames. ``every`` to ``images`` are for pictures, ``sequences`` is for trackers.
    """
    given = [] if predictions is None else [path_of(predictions)]
    default = f"{os.path.splitext(given[0])[0]}-evaluation" if given else "baselines-evaluation"
    folder = Path(out) if out is not None else Path(default)
    arguments = ["eval", path_of(dataset), *given, "--out", path_of(folder), "--json"]
    arguments += _options(
        kind=kind, split=names_of("splits", splits), camera=names_of("cameras", cameras), frame=frame, origin=origin, anchor=anchor,
        input=input, history=history, horizon=horizon, stride=stride, missing_as_zero=missing_as_zero, resamples=resamples, seed=seed,
        every=every, depth_per_metre=depth_per_metre, max_depth_m=max_depth_m, category=categories, images=images, sequences=sequences,
        jobs=jobs,
    )  # fmt: skip
    code, text, _ = _call(arguments, b"", False)
    return EvaluateResult(json.loads(text), folder, code == 0)


@options(split="`splits`", trajectory="`trajectory_ids`")
def export(
    dataset: PathLike,
    format: str,
    out: PathLike,
    *,
    splits: str | Sequence[str] = (),
    trajectory_ids: str | Sequence[str] = (),
    jobs: int | None = None,
    progress: Progress = True,
    **format_options: Option,
) -> ExportResult:
    """Write a dataset in another format. ``format_options`` are those of the format, as the reference of formats has them."""
    arguments = ["export", path_of(dataset), "--format", format, "--out", path_of(out), "--json"]
    arguments += _options(split=names_of("splits", splits), trajectory=names_of("trajectory_ids", trajectory_ids), jobs=jobs, **format_options)
    _, text, _ = _call(arguments, b"", progress)
    found = json.loads(text)
    return ExportResult(**{**found, "out": Path(found["out"])})


@options(trajectory="`trajectory_id`")
def preview(
    dataset: PathLike, trajectory_id: str | None = None, *, frames: str | Sequence[int] | None = None,
    out: PathLike | None = None, progress: Progress = True,
) -> PreviewResult:  # fmt: skip
    """Draw a flight: contact sheet, animated clip, plan of the town with the paths. Notebooks show the result.

    ``frames`` is like ``"0,50,100"`` or ``"0..200:10"``, or a list of numbers; the pictures go to ``out``, beside the dataset by default.
    """
    if frames is not None and not isinstance(frames, str):
        frames = ",".join(map(str, frames)) if hasattr(frames, "__iter__") else str(frames)
    arguments = ["preview", path_of(dataset), "--json", *_options(trajectory=trajectory_id, frames=frames, out=out)]
    _, text, _ = _call(arguments, b"", progress)
    found = json.loads(text)
    return PreviewResult(found["trajectory"], *(Path(path) for path in found["files"]))


def _with_recipe(
    command: list[str], recipe: Recipe, changes: Settings, options: list[str], progress: Progress,
    more: Sequence[str] = (),
) -> tuple[int, str, list[str]]:  # fmt: skip
    given, text = ("-", _toml.dumps(recipe)) if isinstance(recipe, Mapping) else (path_of(recipe, "a recipe"), "")
    return _call([*command, given, *more, *_settings(changes), *options], text.encode(), progress)


def settings_of(changes: Settings, option: str = "set", such_as: str = "{'stages.walkers.count': 8}") -> list[str]:
    """Changes to a recipe as ``path=value`` each."""
    if changes is not None and not isinstance(changes, Mapping):
        raise WrongType(f"`{option}` is {changes!r}; it must be a dictionary, such as {such_as}")
    # Texts stay bare, as on the command line; other values are TOML.
    return [f"{key}={it if isinstance(it, str) else _toml.value_text(it)}" for key, it in (changes or {}).items()]


def _settings(changes: Settings) -> list[str]:
    return [part for change in settings_of(changes) for part in ("--set", change)]


def _mesh(mesh: PathLike | None, keys: Settings, town: str | None) -> list[str]:
    return _options(mesh=mesh, mesh_set=settings_of(keys, "mesh_set", "{'up_axis': 'z'}"), mesh_town=town)


def _options(**options: Any) -> list[str]:
    arguments: list[str] = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is True:
                arguments.append(flag)
            elif one is not None and one is not False:
                arguments.append(f"{flag}={os.fspath(one) if hasattr(one, '__fspath__') else one}")
    return arguments


def _call(arguments: list[str], text: bytes, progress: Progress) -> tuple[int, str, list[str]]:
    if callable(progress):
        return _cosfly.call(arguments, text, progress)
    with Bars(arguments[0], bool(progress), sys.stderr) as bars:
        return _cosfly.call(arguments, text, bars.show if bars.visible else None)
