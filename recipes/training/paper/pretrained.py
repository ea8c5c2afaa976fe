"""A pretrained model of vision and language, fine-tuned on windows: low-rank matrices beside its attention, and a head for waypoints.

It reads the window's last picture and a text: the instruction, the poses before and the boxes. Nothing of the model itself changes.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, Dict, List, Optional

import numpy as np
import small_networks as base
import tools
import torch
from jobs import Unfinished, write_whole
from torch import Tensor, nn

import networks

# The paper: rank 64, 1672 steps of 128 windows.
RANK, BATCH, RATE, KEEP_EVERY = 16, 16, 2e-4, 50
ATTENTION = ("q_proj", "k_proj", "v_proj", "o_proj", "out_proj")
QUESTION = "Where is the drone in the next five frames?"


class LowRank(nn.Module):
    """A frozen layer and, beside it, two small matrices that learn; nothing at first."""

    def __init__(self, layer: nn.Linear) -> None:
        super().__init__()
        self.layer = layer
        self.down, self.up = nn.Linear(layer.in_features, RANK, bias=False), nn.Linear(RANK, layer.out_features, bias=False)
        nn.init.zeros_(self.up.weight)

    def forward(self, numbers: Tensor) -> Tensor:
        return self.layer(numbers) + self.up(self.down(numbers.float())).to(numbers.dtype)


class Pretrained(nn.Module):
    """Pictures and texts -> numbers, from the model's state at the end of the text."""

    def __init__(self, source: str, outputs: int) -> None:
        super().__init__()
        self.processor, self.model = read(source)
        for parameter in self.model.parameters():
            parameter.requires_grad_(False)
        for module in list(self.model.modules()):
            for name, layer in list(module.named_children()):
                if name in ATTENTION and isinstance(layer, nn.Linear):
                    setattr(module, name, LowRank(layer))
        if not any(isinstance(it, LowRank) for it in self.model.modules()):
            raise SystemExit(f"`{source}` has no layers named {', '.join(ATTENTION)}, beside which `--model` learns; give another model")
        self.head = nn.Linear(self.model.get_input_embeddings().embedding_dim, outputs)
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)

    def forward(self, texts: List[str], pictures: List[np.ndarray]) -> Tensor:
        given = self.processor(text=[self.asked(it) for it in texts], images=pictures, return_tensors="pt", padding=True).to(self.head.weight.device)
        if "pixel_values" in given:
            given["pixel_values"] = given["pixel_values"].to(self.model.dtype)
        last = self.model(**given, output_hidden_states=True).hidden_states[-1][:, -1]
        return self.head(last.float())

    def asked(self, text: str) -> str:
        """The text as the model was taught to be asked, with a place for the picture."""
        tokenizer = self.processor.tokenizer
        asker = next((it for it in (self.processor, tokenizer) if getattr(it, "chat_template", None)), None)
        if asker is None:
            return f"{getattr(self.processor, 'image_token', '<image>')}\n{text}"
        content = [{"type": "image"}, {"type": "text", "text": text}]
        return asker.apply_chat_template([{"role": "user", "content": content}], add_generation_prompt=True, tokenize=False)

    def learnt(self) -> Dict[str, Tensor]:
        """What is trained: all else is the pretrained model's."""
        return {name: parameter for name, parameter in self.named_parameters() if parameter.requires_grad}


def read(source: str) -> Any:
    """Processor and model of a folder, or of a name on the hub of Hugging Face."""
    tools.need("transformers", "PIL")
    import transformers

    kind = getattr(transformers, "AutoModelForImageTextToText", None) or transformers.AutoModelForVision2Seq
    precision = torch.bfloat16 if torch.cuda.is_available() else torch.float32
    try:
        processor = transformers.AutoProcessor.from_pretrained(source)
        model = kind.from_pretrained(source, torch_dtype=precision)
    except (OSError, ValueError, KeyError, AttributeError, ImportError) as error:
        told = str(error).strip().splitlines()[0]
        raise SystemExit(
            f"`{source}` is no model of vision and language that transformers {transformers.__version__} reads: {told}\n"
            "give a folder of `save_pretrained`, or a name on the hub, such as Qwen/Qwen3-VL-2B-Instruct"
        ) from None
    processor.tokenizer.padding_side = "left"  # the end of each text is the last place
    return processor, model


def texts_of(windows: base.Windows) -> List[str]:
    """What the model is told of each window."""
    told = lambda rows: "; ".join(" ".join(f"{number:.2f}" for number in row) for row in rows)
    poses = base.relative(windows.current, windows.before)
    boxes = windows.boxes_px / np.tile(windows.image_px, 2)[:, None]
    return [
        f"{instruction} Poses before, seen from now (ahead, right, up in m; pitch, yaw, roll in degrees): {told(before)}. Boxes of the target "
        f"(left, top, right, bottom; shares of the picture): {told(seen)}. {QUESTION}"
        for instruction, before, seen in zip(windows.table["instruction_en"].to_pylist(), poses, boxes)
    ]


def fine_tuned(
    source: str, pack: Any, lessons: base.Windows, judged: base.Windows, wanted: np.ndarray, steps: int, seed: int, kept: Path, end: Optional[float]
) -> np.ndarray:
    """Numbers for each judged window. Where the time is over, what was learnt is kept in a file, and training goes on there the next time."""
    torch.manual_seed(seed)
    place = networks.device()
    network = Pretrained(source, wanted.shape[1]).to(place)
    optimiser = torch.optim.AdamW(network.learnt().values(), RATE)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, steps)
    done, draws = 0, np.random.default_rng(seed).integers(len(lessons), size=(steps, BATCH))
    if kept.exists():
        state = torch.load(kept, map_location=place)
        network.load_state_dict(state["learnt"], strict=False)
        optimiser.load_state_dict(state["optimiser"])
        schedule.load_state_dict(state["schedule"])
        done = state["done"]
    texts, places = texts_of(lessons), pack.rows(lessons)[:, -1]
    pictures = lambda rows: [it.cpu().numpy() for it in pack.frames[torch.from_numpy(rows)]]
    for step in range(done, steps):
        if end is not None and step % KEEP_EVERY == 0 and step > done and time.monotonic() > end:
            state = {"learnt": network.learnt(), "optimiser": optimiser.state_dict(), "schedule": schedule.state_dict(), "done": step}
            write_whole(kept, lambda file: torch.save(state, file))
            raise Unfinished(f"{step} of {steps} steps")
        rows = draws[step]
        found = network([texts[row] for row in rows], pictures(places[rows]))
        loss = nn.functional.smooth_l1_loss(found, torch.from_numpy(wanted[rows]).to(place))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    texts, places, told = texts_of(judged), pack.rows(judged)[:, -1], []
    with torch.no_grad():
        for rows in np.array_split(np.arange(len(judged)), -(-len(judged) // BATCH)):
            told.append(network([texts[row] for row in rows], pictures(places[rows])).cpu().numpy())
    kept.unlink(missing_ok=True)
    return np.concatenate(told).astype(np.float64)
