"""Fine-tuning of a pretrained model of vision and language (`recipes/training/paper/pretrained.py`), with a tiny model of random weights: it is read
as real ones are, learns, goes on after an end in the middle as if there had been none, and wrong folders are told in a line.

    python tests/outside/check_pretrained.py DATASET SCRATCH
"""

import os
import pathlib
import sys
import time

os.environ["HF_HUB_OFFLINE"] = "1"
here = pathlib.Path(__file__).resolve().parents[2] / "recipes/training"
sys.path[:0] = [str(here), str(here / "paper")]

import numpy as np
import torch
import transformers
from tokenizers import Tokenizer, decoders, models, pre_tokenizers

import jobs
import pretrained
import rows
from pictures import Pack

IMAGE, PAD = "<image>", "<pad>"


def write_model(folder):
    """As `save_pretrained` writes real ones: a picture of 28 pixels, texts by bytes."""
    letters = sorted(pre_tokenizers.ByteLevel.alphabet())
    bytes_ = Tokenizer(models.BPE({letter: place for place, letter in enumerate(letters)}, []))
    bytes_.pre_tokenizer, bytes_.decoder = pre_tokenizers.ByteLevel(add_prefix_space=False), decoders.ByteLevel()
    tokenizer = transformers.PreTrainedTokenizerFast(
        tokenizer_object=bytes_, pad_token=PAD, additional_special_tokens=[IMAGE], model_input_names=["input_ids", "attention_mask"]
    )
    sizes = {"hidden_size": 32, "intermediate_size": 48, "num_hidden_layers": 2, "num_attention_heads": 2}
    config = transformers.LlavaConfig(
        transformers.CLIPVisionConfig(**sizes, image_size=28, patch_size=14),
        transformers.LlamaConfig(**sizes, vocab_size=len(tokenizer), max_position_embeddings=2048, pad_token_id=tokenizer.pad_token_id),
        image_token_index=tokenizer.convert_tokens_to_ids(IMAGE),
        pad_token_id=tokenizer.pad_token_id,
        vision_feature_layer=-1,
    )
    torch.manual_seed(0)
    pictures = transformers.CLIPImageProcessor(size={"shortest_edge": 28}, crop_size={"height": 28, "width": 28})
    transformers.LlavaProcessor(pictures, tokenizer).save_pretrained(folder)
    transformers.LlavaForConditionalGeneration(config).save_pretrained(folder)


def main(dataset, work):
    work.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(1)
    source = str(work / "model")
    write_model(source)
    pack = Pack(dataset, work / "pack")
    lessons = rows.PaperWindows(dataset, ["train"], [rows.PERTURBED], "expert")
    pretrained.KEEP_EVERY, pretrained.BATCH, kept = 2, 4, work / "learnt.pt"
    tuned = lambda steps, end: rows.fine_tuned(source, lessons, lessons, pack, steps, 0, kept, end)
    whole = tuned(4, None)
    try:
        tuned(4, time.monotonic())
        raise AssertionError("training has not stopped")
    except jobs.Unfinished as left:
        assert str(left) == "2 of 4 steps" and kept.exists(), left
    assert np.array_equal(tuned(4, time.monotonic() + 1e6), whole) and not kept.exists()
    untrained = tuned(1, None)
    assert whole.shape == (len(lessons), len(rows.METRICS)) and not np.array_equal(whole, untrained)
    for wrong in (work / "none", work / "pack"):
        try:
            pretrained.read(str(wrong))
            raise AssertionError(f"{wrong} was read")
        except SystemExit as told:
            assert str(wrong) in str(told) and "save_pretrained" in str(told), told
    print(f"{len(lessons)} windows: FDE {whole[:, rows.FDE].mean():.2f} m after four steps, {untrained[:, rows.FDE].mean():.2f} after one")


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:3]))
