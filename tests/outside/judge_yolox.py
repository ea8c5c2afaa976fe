"""A third network for judge_pictures.py: YOLOX-Nano, which others trained on COCO, in the form that ncnn reads.

The weights are `yolox-nano.param` and `yolox-nano.bin`, as in github.com/nihui/ncnn-android-yolox, app/src/main/assets; `pip install ncnn` runs them."""

from pathlib import Path

import numpy as np
from PIL import Image

SIDE, STRIDES, LEAST = 416, (8, 16, 32), 0.05
MEAN, DEVIATION = np.array([0.485, 0.456, 0.406]) * 255, np.array([0.229, 0.224, 0.225]) * 255
NAMES = {0: "person", 1: "bicycle", 2: "car", 3: "motorcycle", 5: "bus", 7: "truck"}


class Yolox:
    """The network of a folder."""

    def __init__(self, folder):
        try:
            import ncnn
        except ImportError:
            raise SystemExit("judge_pictures: `--yolox` needs a package: pip install ncnn") from None
        param, weights = Path(folder) / "yolox-nano.param", Path(folder) / "yolox-nano.bin"
        for file in (param, weights):
            if not file.is_file():
                raise SystemExit(f"judge_pictures: there is no `{file}`; take both files from github.com/nihui/ncnn-android-yolox")
        # The first layer, which ncnn does not have, is `halves` below: what comes behind it is the input.
        magic, counts, *layers = param.read_text().splitlines()
        first = next(line.split() for line in layers if line.startswith("YoloV5Focus"))
        layers = [line for line in layers if not line.startswith(("Input ", "YoloV5Focus"))]
        _, blobs = map(int, counts.split())
        text = "\n".join([magic, f"{len(layers) + 1} {blobs - 1}", f"Input images 0 1 {first[-1]}", *layers]) + "\n"
        self.ncnn, self.net, self.input = ncnn, ncnn.Net(), first[-1]
        self.net.opt.num_threads = 1
        if self.net.load_param_mem(text) != 0 or self.net.load_model(str(weights)) != 0:
            raise SystemExit(f"judge_pictures: ncnn cannot read `{param}` and `{weights}`")

    def boxes(self, square):
        """Rows of left, top, right, bottom as shares of the square, score, COCO's name: people and vehicles alone."""
        picture = (np.asarray(square.resize((SIDE, SIDE), Image.Resampling.BILINEAR), dtype=float) - MEAN) / DEVIATION
        halves = [picture[row::2, column::2].transpose(2, 0, 1) for column in (0, 1) for row in (0, 1)]
        extractor = self.net.create_extractor()
        numbers = np.ascontiguousarray(np.concatenate(halves), dtype=np.float32)  # ncnn reads it while it lives
        extractor.input(self.input, self.ncnn.Mat(numbers))
        _, out = extractor.extract("output")
        cells = [(x, y, stride) for stride in STRIDES for y in range(SIDE // stride) for x in range(SIDE // stride)]
        rows, grid = np.array(out, copy=True), np.array(cells, dtype=float)
        middle, half = (rows[:, :2] + grid[:, :2]) * grid[:, 2:], np.exp(np.minimum(rows[:, 2:4], 20.0)) * grid[:, 2:] / 2
        edges = np.concatenate([middle - half, middle + half], axis=1) / SIDE
        found = []
        for kind, name in NAMES.items():
            scores = rows[:, 4] * rows[:, 5 + kind]
            found += [[*map(float, edges[at]), float(scores[at]), name] for at in np.flatnonzero(scores > LEAST)]
        return found
