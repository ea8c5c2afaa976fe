"""The network family of `run.py`: two hidden layers on poses, boxes and distances, and a small encoder where a row sees pictures."""

from __future__ import annotations

import math
from typing import List, Optional

import numpy as np
import torch
from torch import Tensor, nn

HIDDEN, BATCH, RATE, DECAY = 128, 128, 2e-3, 1e-2
OF_PICTURE = 24


class Encoder(nn.Module):
    """Numbers of each picture: (batch, frames, 3, height, width) -> (batch, frames * OF_PICTURE)."""

    def __init__(self) -> None:
        super().__init__()
        widths = [3, 16, 32, 48, 64]
        layers: List[nn.Module] = []
        for before, after in zip(widths, widths[1:]):
            layers += [nn.Conv2d(before, after, 3, stride=2, padding=1), nn.GroupNorm(4, after), nn.ReLU()]
        self.layers = nn.Sequential(*layers, nn.AdaptiveAvgPool2d((3, 4)), nn.Flatten(), nn.Linear(64 * 12, OF_PICTURE))

    def forward(self, pictures: Tensor) -> Tensor:
        return self.layers(pictures.flatten(0, 1)).reshape(len(pictures), -1)


class Network(nn.Module):
    """Numbers and pictures of a window's input -> its waypoints, all of mean 0 and spread 1 in training."""

    def __init__(self, numbers: int, frames: int, outputs: int) -> None:
        super().__init__()
        self.encoder = Encoder() if frames else None
        self.layers = nn.Sequential(
            nn.Linear(numbers + frames * OF_PICTURE, HIDDEN), nn.ReLU(), nn.Linear(HIDDEN, HIDDEN), nn.ReLU(), nn.Linear(HIDDEN, outputs)
        )
        nn.init.zeros_(self.layers[-1].weight)
        nn.init.zeros_(self.layers[-1].bias)

    def forward(self, numbers: Tensor, pictures: Optional[Tensor]) -> Tensor:
        if self.encoder is not None:
            numbers = torch.cat([numbers, self.encoder(pictures)], dim=1)
        return self.layers(numbers)


class Pictures:
    """Pictures of windows: all frames (frames, height, width, 3), uint8, and each window's places in them; mirrored where asked."""

    def __init__(self, frames: Tensor, rows: np.ndarray, mirrored: np.ndarray) -> None:
        self.frames, self.rows, self.mirrored = frames, torch.from_numpy(rows), torch.from_numpy(mirrored)

    def of(self, windows: Tensor) -> Tensor:
        pictures = self.frames[self.rows[windows].to(self.frames.device)].permute(0, 1, 4, 2, 3).float() / 255 - 0.5
        flipped = self.mirrored[windows].to(self.frames.device)[:, None, None, None, None]
        return torch.where(flipped, pictures.flip(-1), pictures)


def device() -> torch.device:
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def train(numbers: np.ndarray, learnt: np.ndarray, pictures: Optional[Pictures], steps: int, seed: int) -> Network:
    """Adam with decay on the Huber loss; the rate rises for a twentieth of the steps and falls along half a cosine."""
    torch.manual_seed(seed)
    draws = torch.Generator().manual_seed(seed)
    place = device()
    seen, wanted = torch.from_numpy(numbers).to(place), torch.from_numpy(learnt).to(place)
    network = Network(seen.shape[1], 0 if pictures is None else pictures.rows.shape[1], wanted.shape[1]).to(place)
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=DECAY)
    rise = max(1, steps // 20)
    schedule = torch.optim.lr_scheduler.LambdaLR(
        optimiser, lambda step: min((step + 1) / rise, 0.5 * (1 + math.cos(math.pi * step / steps)))
    )
    for _ in range(steps):
        rows = torch.randint(len(seen), (BATCH,), generator=draws)
        on_place = rows.to(place)
        found = network(seen[on_place], None if pictures is None else pictures.of(rows))
        loss = nn.functional.smooth_l1_loss(found, wanted[on_place])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    return network


@torch.no_grad()
def predict(network: Network, numbers: np.ndarray, pictures: Optional[Pictures]) -> np.ndarray:
    parts = []
    for rows in torch.arange(len(numbers)).split(256):
        seen = torch.from_numpy(numbers[rows.numpy()]).to(device())
        parts.append(network(seen, None if pictures is None else pictures.of(rows)).cpu().numpy())
    return np.concatenate(parts).astype(np.float64)
