// Two networks of others, trained on COCO, name things in squares of pictures: the back half of judge_pictures.py.
//
//     node judge_networks.mjs NODE_MODULES < squares > answers
//
// NODE_MODULES has the packages that judge_pictures.py installs. Standard input: one square after the other, each a byte (1: NanoDet is
// asked, too), the 512 x 512 x 3 bytes of CenterNet's input and the 416 x 416 x 3 of NanoDet's, rows of red, green, blue. Standard output:
// a line of JSON for each: `centernet` and `nanodet`, lists of [left, top, right, bottom, score, class] with edges as shares of the square
// and COCO's names of classes; `features`, the mean of CenterNet's backbone over the square, 88 numbers.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const modules = resolve(process.argv[2]);
const require = createRequire(join(modules, "of_the_packages.cjs"));
const tf = require("@tensorflow/tfjs-core");
const { loadGraphModel } = require("@tensorflow/tfjs-converter");
const wasm = require("@tensorflow/tfjs-backend-wasm");

const COCO = `person,bicycle,car,motorcycle,airplane,bus,train,truck,boat,traffic light,fire hydrant,stop sign,parking meter,bench,bird,cat,dog,
horse,sheep,cow,elephant,bear,zebra,giraffe,backpack,umbrella,handbag,tie,suitcase,frisbee,skis,snowboard,sports ball,kite,baseball bat,
baseball glove,skateboard,surfboard,tennis racket,bottle,wine glass,cup,fork,knife,spoon,bowl,banana,apple,sandwich,orange,broccoli,carrot,
hot dog,pizza,donut,cake,chair,couch,potted plant,bed,dining table,toilet,tv,laptop,mouse,remote,keyboard,cell phone,microwave,oven,toaster,
sink,refrigerator,book,clock,vase,scissors,teddy bear,hair drier,toothbrush`.replaceAll("\n", "").split(",");
const CENTERNET = { side: 512, boxes: "tower_0/detections", features: "tower_0/MobilenetV3/expanded_conv_11/project/BatchNorm/FusedBatchNorm" };
const NANODET = { side: 416, strides: [8, 16, 32], bins: 11, classes: 80, least: 0.05 };

async function network(name) {
  const folder = join(modules, "@vladmandic", "human-models", "models");
  const described = JSON.parse(readFileSync(join(folder, `${name}.json`), "utf8"));
  const weights = readFileSync(join(folder, `${name}.bin`));
  return loadGraphModel({
    load: async () => ({
      modelTopology: described.modelTopology,
      weightSpecs: described.weightsManifest.flatMap((part) => part.weights),
      weightData: weights.buffer.slice(weights.byteOffset, weights.byteOffset + weights.byteLength),
    }),
  });
}

function centernet(model, bytes) {
  const { side } = CENTERNET;
  return tf.tidy(() => {
    const input = tf.tensor(Float32Array.from(bytes), [1, side, side, 3]);
    const [found, features] = model.execute(input, [CENTERNET.boxes, CENTERNET.features]);
    const rows = tf.reshape(found, [-1, 6]).arraySync().filter((row) => row[4] > 0.01);
    const boxes = rows.map(([x0, y0, x1, y1, score, kind]) => [x0 / side, y0 / side, x1 / side, y1 / side, score, COCO[kind]]);
    return [boxes, tf.mean(features, [0, 1, 2]).arraySync()];
  });
}

function nanodet(model, bytes) {
  const { side, strides, bins, classes, least } = NANODET;
  return tf.tidy(() => {
    const picture = tf.tensor(Float32Array.from(bytes, (value) => value / 255), [side, side, 3]);
    const names = strides.flatMap((_, level) => [`Identity_${level}:0`, `Identity_${level + strides.length}:0`]);
    const outputs = model.execute(tf.expandDims(tf.transpose(picture, [2, 0, 1]), 0), names.map((name) => name.replace("Identity_0", "Identity")));
    return strides.flatMap((stride, level) => {
      const scores = outputs[2 * level].dataSync();
      const distances = outputs[2 * level + 1].dataSync();
      const cells = side / stride;
      const found = [];
      for (let index = 0; index < scores.length; index += 1) {
        if (scores[index] < least) continue;
        const cell = Math.floor(index / classes);
        const [left, top, right, bottom] = [0, 1, 2, 3].map((edge) => (stride / side) * expectation(distances, (4 * cell + edge) * bins, bins));
        const [x, y] = [((cell % cells) + 0.5) / cells, (Math.floor(cell / cells) + 0.5) / cells];
        found.push([x - left, y - top, x + right, y + bottom, scores[index], COCO[index % classes]]);
      }
      return found;
    });
  });
}

function expectation(logits, start, bins) { // of the bin's number, under the softmax of its logits
  const part = Array.from(logits.subarray(start, start + bins));
  const largest = Math.max(...part);
  const weights = part.map((logit) => Math.exp(logit - largest));
  return weights.reduce((sum, weight, bin) => sum + weight * bin, 0) / weights.reduce((sum, weight) => sum + weight, 0);
}

wasm.setWasmPaths(join(modules, "@tensorflow", "tfjs-backend-wasm", "wasm-out") + "/");
wasm.setThreadsCount(1); // the same sums in the same order, everywhere
await tf.setBackend("wasm");
await tf.ready();
const models = { centernet: await network("centernet"), nanodet: await network("nanodet") };
const [middle, end] = [1 + 3 * CENTERNET.side ** 2, 1 + 3 * CENTERNET.side ** 2 + 3 * NANODET.side ** 2];
let pending = Buffer.alloc(0);
for await (const chunk of process.stdin) {
  pending = Buffer.concat([pending, chunk]);
  while (pending.length >= end) {
    const [boxes, features] = centernet(models.centernet, pending.subarray(1, middle));
    const people = pending[0] === 1 ? nanodet(models.nanodet, pending.subarray(middle, end)) : [];
    process.stdout.write(JSON.stringify({ centernet: boxes, nanodet: people, features }) + "\n");
    pending = pending.subarray(end);
  }
}
