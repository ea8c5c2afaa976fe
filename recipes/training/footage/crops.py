"""Squares around people and vehicles of a dataset of cosfly, with the boxes of everybody in them, and views drawn from them in training."""

from __future__ import annotations

import math
from typing import Any, Dict, List, NamedTuple, Tuple

import numpy as np
import torch
from PIL import Image
from torch import Tensor
from torch.nn import functional

KEPT, SIDE = 320, 160  # sides of the squares in memory and of the networks' input, pixels
HEIGHT = 40.0  # longer side of the body in the middle of a square in memory, pixels; smaller bodies stay as small as they are
LEAST_PX, LEAST_PIXELS, LEAST_SHOWN = 8.0, 16, 0.3  # who shows less is neither looked for nor an error
VEHICLES = {"bicycle", "motorcycle", "car", "van", "truck", "bus", "drone"}  # all other kinds of bodies are people
Box = Tuple[float, float, float, float]  # left, top, right, bottom edges, pixels


class Seen(NamedTuple):
    body: str
    box: Box
    is_person: bool
    is_clear: bool


class Squares(NamedTuple):
    pictures: Tensor  # (squares, 3, KEPT, KEPT), uint8
    around: List[List[Seen]]  # who is in each square, in its pixels
    bodies: List[Tuple[str, str]]  # flight and body in the middle; "" where the square is anywhere
    lengths: np.ndarray  # longer side of the body in the middle, pixels


def cut(picture: Image.Image, middle: Tuple[float, float], side: float, pixels: int) -> Tuple[np.ndarray, Tuple[float, float, float]]:
    """The square around `middle`, black beyond the picture, scaled to `pixels`; its left and top edge, and pixels per pixel."""
    left, top = middle[0] - side / 2, middle[1] - side / 2
    column, line, whole = math.floor(left), math.floor(top), math.ceil(side) + 1
    edges = (left - column, top - line, left - column + side, top - line + side)
    square = picture.crop((column, line, column + whole, line + whole)).resize((pixels, pixels), Image.Resampling.BILINEAR, edges)
    return np.asarray(square), (left, top, pixels / side)


def seen_in(dataset: Any) -> Dict[Tuple[str, int], List[Seen]]:
    """Who each frame shows, the target first."""
    seen: Dict[Tuple[str, int], List[Seen]] = {}
    columns = {
        "frames": ["visible_box_px", "visible_pixels", "visible_by_pixels"],
        "bodies": ["visible_box_px", "visible_pixels", "body_id", "kind"],
    }
    for name, names in columns.items():
        table = dataset.table(name)
        for flight, frame, box, pixels, *rest in zip(*(table[it] for it in ["trajectory_id", "frame", *names])):
            if pixels > 0:
                area, longer = (box[2] - box[0]) * (box[3] - box[1]), max(box[2] - box[0], box[3] - box[1])
                is_target = name == "frames"
                shown = rest[0] if is_target else pixels / max(area, 1.0) * 2  # a whole person fills half of the box, or nearly
                is_clear = pixels >= LEAST_PIXELS and shown >= LEAST_SHOWN and longer >= LEAST_PX
                body, is_person = ("target", True) if is_target else (str(rest[0]), rest[1] not in VEHICLES)
                seen.setdefault((str(flight), int(frame)), []).append(Seen(body, tuple(map(float, box)), is_person, bool(is_clear)))
    return seen


def squares_of(dataset: Any, per_frame: int, seed: int) -> Squares:
    """Squares of each frame: around the target and around others who are seen clearly, `per_frame` in all, and one anywhere."""
    draws, seen = np.random.default_rng(seed), seen_in(dataset)
    pictures = torch.empty((len(dataset) * (per_frame + 1), 3, KEPT, KEPT), dtype=torch.uint8)
    around: List[List[Seen]] = []
    bodies: List[Tuple[str, str]] = []
    lengths: List[float] = []
    for number in range(len(dataset)):
        sample = dataset[number]
        place = (sample["trajectory_id"], int(sample["frame"]))
        clear = [it for it in seen.get(place, []) if it.is_clear and in_reach(it.box)]
        others = [it for it in clear if it.body != "target"]
        chosen = [it for it in clear if it.body == "target"] + [others[it] for it in draws.permutation(len(others))]
        picture = Image.fromarray(sample["rgb"])
        anywhere = tuple(draws.uniform(KEPT / 2, max(KEPT / 2, length - KEPT / 2)) for length in picture.size)
        for it in [*chosen[:per_frame], None]:
            middle, body = anywhere, ""
            if it:
                left, top, right, bottom = it.box
                length, middle, body = max(right - left, bottom - top), ((left + right) / 2, (top + bottom) / 2), it.body
                side = max(KEPT, length * KEPT / HEIGHT)
            elif not chosen:
                break
            square, (x, y, scale) = cut(picture, middle, side, KEPT)
            moved = [other._replace(box=tuple((edge - (x, y)[place % 2]) * scale for place, edge in enumerate(other.box))) for other in seen[place]]
            pictures[len(bodies)] = torch.from_numpy(np.array(square)).permute(2, 0, 1)
            around.append([other for other in moved if other.box[2] > 0 and other.box[3] > 0 and other.box[0] < KEPT and other.box[1] < KEPT])
            bodies.append((place[0], body))
            lengths.append(length * KEPT / side)
    if not bodies:
        raise SystemExit("footage: the dataset shows nobody clearly")
    return Squares(pictures[: len(bodies)], around, bodies, np.array(lengths))


def in_reach(box: Box) -> bool:
    return LEAST_PX <= max(box[2] - box[0], box[3] - box[1]) <= 120


class View(NamedTuple):
    """A square seen anew: turned, scaled, moved, perhaps mirrored. Maps pixels of the square to pixels of the view."""

    pictures: Tensor
    map: np.ndarray  # (views, 2, 3)


def views(pictures: Tensor, side: int, scales: np.ndarray, moves: np.ndarray, turns: np.ndarray, mirrors: np.ndarray) -> View:
    """Views of squares: `scales` pixels per pixel, the square's middle at `moves` (-1 to 1 over half of the view) in the view."""
    cos, sin = np.cos(turns) * scales, np.sin(turns) * scales
    flip = np.where(mirrors, -1.0, 1.0)
    linear = np.stack([np.stack([cos * flip, -sin], 1), np.stack([sin * flip, cos], 1)], 1)  # (views, 2, 2), about the middle
    shift = moves * side / 2
    inverse = linear.transpose(0, 2, 1) / (scales**2)[:, None, None]
    theta = np.concatenate([inverse * side / KEPT, (-(inverse @ shift[:, :, None])) / (KEPT / 2)], axis=2)
    grid = functional.affine_grid(torch.from_numpy(theta).float(), [len(pictures), 3, side, side], align_corners=False)
    seen = functional.grid_sample(pictures.float(), grid, mode="bilinear", padding_mode="border", align_corners=False)
    offset = shift + side / 2 - (linear @ np.full((2, 1), KEPT / 2))[:, :, 0]
    return View(seen, np.concatenate([linear, offset[:, :, None]], axis=2))


def moved(box: Box, of: np.ndarray) -> np.ndarray:
    """The box in a view: around the middles of the box's edges, which a small turn does not widen."""
    left, top, right, bottom = box
    x, y = (left + right) / 2, (top + bottom) / 2
    ends = np.array([[left, y, 1], [right, y, 1], [x, top, 1], [x, bottom, 1]]) @ of.T
    return np.concatenate([ends.min(axis=0), ends.max(axis=0)])


def coarse(pictures: Tensor, pooled: np.ndarray, smear: np.ndarray, draws: np.random.Generator) -> Tensor:
    """Smaller and farther, or a moving camera: every `pooled` pixels become one, and a fifth of the pictures is blurred along `smear`."""
    side = pictures.shape[-1]
    for few in np.unique(pooled[pooled > 1]):
        rows = torch.from_numpy(pooled == few)
        pictures[rows] = functional.interpolate(functional.avg_pool2d(pictures[rows], int(few)), size=side, mode="bilinear", align_corners=False)
    rows = torch.from_numpy(draws.random(len(pictures)) < 0.2)
    moving = pictures[rows]
    pictures[rows] = torch.stack([moving.roll((int(it * smear[0]), int(it * smear[1])), (2, 3)) for it in range(-2, 3)]).mean(dim=0)
    return pictures


def coloured(pictures: Tensor, draws: np.random.Generator) -> Tensor:
    """Other cameras: exposure, colour balance, contrast, saturation, blur or sharpening, noise; 0 to 255 in, about -2 to 2 out."""
    count = len(pictures)
    drawn = lambda low, high, channels=1: torch.from_numpy(draws.uniform(low, high, (count, channels, 1, 1))).float()
    light = (pictures / 255).clamp(0, 1) ** torch.exp(drawn(-0.45, 0.45))
    light = light * torch.exp(drawn(-0.35, 0.35)) * torch.exp(drawn(-0.12, 0.12, 3))
    grey = light.mean(dim=1, keepdim=True)
    light = grey + (light - grey) * drawn(0.3, 1.5)
    middle = light.mean(dim=(1, 2, 3), keepdim=True)
    light = middle + (light - middle) * drawn(0.6, 1.5)
    soft = functional.avg_pool2d(light, 3, 1, 1, count_include_pad=False)
    light = light + (light - soft) * drawn(-0.9, 1.2)
    light = light + torch.from_numpy(draws.standard_normal(light.shape, dtype=np.float32)) * drawn(0, 0.04)
    return (light.clamp(0, 1) - 0.5) * 4


def as_input(square: np.ndarray) -> Tensor:
    """(height, width, 3), uint8 -> what networks see."""
    return (torch.from_numpy(np.array(square)).permute(2, 0, 1).float() / 255 - 0.5) * 4
