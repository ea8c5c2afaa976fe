"""Loads an export of format vlm with the loaders of LLaMA-Factory and ms-swift, those of them that are installed.

Usage: `check_vlm_loaders.py EXPORT_FOLDER`. Every line must become a question with as many `<image>` as pictures, which exist, and an answer."""

import importlib.machinery
import importlib.util
import json
import os
import sys
import tempfile
import types
from pathlib import Path

os.chdir(sys.argv[1])  # names of pictures are those of the folder


def llamafactory():
    # It imports torchaudio, for sound, which these sets do not have; the package index pairs it with another CUDA than torch's.
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

    folder = str(Path.cwd())
    names = list(json.loads(Path("dataset_info.json").read_text()))
    data = DataArguments(dataset=",".join(names), dataset_dir=folder, media_dir=folder)
    with tempfile.TemporaryDirectory() as out:
        training = Seq2SeqTrainingArguments(output_dir=out, report_to=[])
        for name, entry in zip(names, get_dataset_list(names, folder)):
            rows = _load_single_dataset(entry, ModelArguments(model_name_or_path="none"), data, training)
            check_lines(Path(f"{name.removeprefix('cosfly_')}.jsonl"), rows)
            is_waypoints = not name.endswith(("_texts", "_preferences", "_goals", "_goal_checks", "_dialogues"))
            for row in rows:
                question, answer = row["_prompt"][0]["content"], row["_response"][0]["content"]
                pictures = row["_images"] or []
                assert question.count("<image>") == len(pictures) and ("Instruction: " in question) == is_waypoints, row
                assert pictures or name.endswith("_no_pictures"), row
                assert all(Path(picture).is_file() for picture in pictures) and row["_system"], row
                assert not is_waypoints or json.loads(answer)["waypoint_deltas"], answer
                assert not name.endswith("_preferences") or len(row["_response"]) == 2, row


def swift():
    from swift.dataset import load_dataset

    # Pairs have two forms; the one without an ending of its own is LLaMA-Factory's.
    for path in sorted(path for path in Path(".").glob("*.jsonl") if not path.stem.endswith("_preferences")):
        rows, _ = load_dataset([str(path)], split_dataset_ratio=0.0, num_proc=1, strict=True)
        check_lines(path, rows)
        for row in rows:
            assert [message["role"] for message in row["messages"]] == ["system", "user", "assistant"], row
            assert row["messages"][1]["content"].count("<image>") == len(row.get("images") or []), row
            assert not path.stem.endswith("_swift") or row["rejected_response"], row


def check_lines(path, rows):
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert len(rows) == lines, (path, len(rows), lines)
    print(f"ok  {path}: {lines} lines")


for package, check in {"llamafactory": llamafactory, "ms-swift": swift}.items():
    if importlib.util.find_spec(check.__name__) is None:
        print(f"skipped: {package} is not installed (pip install {package})")
    else:
        check()
