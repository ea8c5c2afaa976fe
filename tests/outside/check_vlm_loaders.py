"""Holds an export of format vlm to what the readers of LLaMA-Factory (sharegpt, ranking) and ms-swift (rejected_response) document, and loads it with
those of them that are installed.

Usage: `check_vlm_loaders.py EXPORT_FOLDER`. Every line must become a question with as many `<image>` as pictures, which exist, and an answer."""

import importlib.machinery
import importlib.util
import json
import os
import sys
import tempfile
import types
from collections import Counter
from pathlib import Path

from shared import json_lines

os.chdir(sys.argv[1])  # names of pictures are those of the folder


def documented():
    """Names, roles, pictures and answers by the rules of both readers; returns how many pairs there are."""
    registered = json.loads(Path("dataset_info.json").read_text())
    files, pairs = {path.stem: json_lines(path) for path in Path(".").glob("*.jsonl")}, Counter()
    assert {f"cosfly_{name}" for name in files if not name.endswith("_swift")} == set(registered), (files.keys(), registered.keys())
    for name, entry in registered.items():
        assert entry["tags"] == {f"{name}_tag": name for name in ("role", "content", "user", "assistant", "system")}, entry
        wanted = ["messages", *["images"] * (not name.endswith("_no_pictures")), *["chosen", "rejected"] * entry.get("ranking", False)]
        assert entry["formatting"] == "sharegpt" and entry["columns"] == {it: it for it in wanted} and entry["file_name"] == f"{name.removeprefix('cosfly_')}.jsonl", entry
    for name, lines in files.items():
        assert len({row["id"] for row in lines}) == len(lines) > 0, name
        is_ranking, is_of_swift = name.endswith("_preferences"), name.endswith("_swift")
        pairs += Counter({"ranking": len(lines) * is_ranking, "swift": len(lines) * is_of_swift})
        for row in lines:
            assert not {"rejected_messages", "objects", "videos", "audios", *["rejected_response"] * (not is_of_swift)} & set(row), "keys with a meaning of their own"
            assert [message["role"] for message in row["messages"]] == ["system", "user", "assistant"][: 2 if is_ranking else 3], row
            asked = "".join(message["content"] for message in row["messages"][1:])  # LLaMA-Factory does not search the first for `<image>`
            assert asked.count("<image>") == len(row["images"]) and all(map(os.path.isfile, row["images"])), row
            if is_ranking:
                assert registered[f"cosfly_{name}"]["ranking"] is True and row["chosen"]["role"] == row["rejected"]["role"] == "assistant"
                assert row["chosen"]["content"] != row["rejected"]["content"] and row["rejected"]["content"].strip()
            assert not is_of_swift or row["rejected_response"].strip(), row
            about_goals = name.endswith(("_goals", "_goal_checks", "_dialogues"))
            assert ("Poses" in asked) == (not about_goals and "no_poses" not in name and "pictures_only" not in name), name
            if name.endswith("_goal_checks"):
                answer = json.loads(row["messages"][2]["content"])
                assert answer["fits"] == (answer["false_subject"] is None), row
            if name.endswith("_dialogues"):
                assert "Pilot: " in asked and json.loads(row["messages"][2]["content"])["claims"], row
    assert pairs["ranking"] == pairs["swift"]
    print(f"{len(files)} files, {pairs['ranking']} pairs")


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
                assert row["_system"], row
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


def check_lines(path, rows):
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert len(rows) == lines, (path, len(rows), lines)
    print(f"ok  {path}: {lines} lines")


documented()
for package, check in {"llamafactory": llamafactory, "ms-swift": swift}.items():
    if importlib.util.find_spec(check.__name__) is None:
        print(f"skipped: {package} is not installed (pip install {package})")
    else:
        check()
