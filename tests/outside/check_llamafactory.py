"""Loads an export of format vlm with LLaMA-Factory's own loader, where it is installed.

    venv/bin/python tests/outside/check_llamafactory.py EXPORT_FOLDER

Every line must become a question with as many `<image>` as pictures, which exist, and an answer.
"""

import importlib.machinery
import importlib.util
import json
import sys
import tempfile
import types
from pathlib import Path

if importlib.util.find_spec("llamafactory") is None:
    print("skipped: LLaMA-Factory is not installed (pip install llamafactory)")
    sys.exit()

# LLaMA-Factory imports torchaudio, for sound, which these sets do not have; the package index pairs it with another CUDA than torch's.
try:
    import torchaudio  # noqa: F401
except (ImportError, OSError, RuntimeError):
    for name in [name for name in sys.modules if name.split(".")[0] == "torchaudio"]:
        del sys.modules[name]
    sys.modules["torchaudio"] = types.ModuleType("torchaudio")
    sys.modules["torchaudio"].__spec__ = importlib.machinery.ModuleSpec("torchaudio", None)

from llamafactory.data.loader import _load_single_dataset
from llamafactory.data.parser import get_dataset_list
from llamafactory.hparams import DataArguments, ModelArguments
from transformers import Seq2SeqTrainingArguments

folder = sys.argv[1]
names = list(json.loads((Path(folder) / "dataset_info.json").read_text()))
data = DataArguments(dataset=",".join(names), dataset_dir=folder, media_dir=folder)
with tempfile.TemporaryDirectory() as out:
    training = Seq2SeqTrainingArguments(output_dir=out, report_to=[])
    for name, entry in zip(names, get_dataset_list(names, folder)):
        rows = _load_single_dataset(entry, ModelArguments(model_name_or_path="none"), data, training)
        lines = (Path(folder) / f"{name.removeprefix('cosfly_')}.jsonl").read_text().splitlines()
        assert len(rows) == len(lines), (name, len(rows), len(lines))
        is_waypoints = not name.endswith(("_texts", "_preferences", "_goals", "_goal_checks", "_dialogues"))
        for row in rows:
            question, answer = row["_prompt"][0]["content"], row["_response"][0]["content"]
            pictures = row["_images"] or []
            assert question.count("<image>") == len(pictures) and ("Instruction: " in question) == is_waypoints, row
            assert pictures or name.endswith("_no_pictures"), row
            assert all(Path(picture).is_file() for picture in pictures) and row["_system"], row
            assert not is_waypoints or json.loads(answer)["waypoint_deltas"], answer
            assert not name.endswith("_preferences") or len(row["_response"]) == 2, row
        print(f"ok  {name}: {len(rows)} windows")
