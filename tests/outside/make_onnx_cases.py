"""Makes the cases of `engine/edge/onnx/tests`: tiny networks, each with inputs and the outputs that ONNX's reference evaluator gives.

    pip install onnx numpy && python tests/outside/make_onnx_cases.py

Inputs and outputs stand in the metadata of each file, as JSON under the key `case`. The reference computes with numpy."""

import json
from pathlib import Path

import numpy as np
from onnx import TensorProto, helper, numpy_helper
from onnx.reference import ReferenceEvaluator

FOLDER = Path(__file__).parents[2] / "engine/edge/onnx/tests/cases"
RANDOM = np.random.default_rng(1)


def floats(*shape):
    """Numbers that a text of six digits holds."""
    return np.round(RANDOM.normal(size=shape), 3).astype(np.float32)


def told(array):
    kind = "floats" if array.dtype == np.float32 else "wholes"
    return {"shape": list(array.shape), kind: array.reshape(-1).astype(float if kind == "floats" else int).tolist()}


def case(name, operator, inputs, outputs=1, constants=(), **settings):
    """One node; those inputs whose numbers are in `constants` are constants of the file."""
    names = [f"in{at}" if value is not None else "" for at, value in enumerate(inputs)]
    made = [f"out{at}" for at in range(outputs)]
    element = lambda array: helper.np_dtype_to_tensor_dtype(array.dtype)
    given = [(n, v) for at, (n, v) in enumerate(zip(names, inputs)) if v is not None and at not in constants]
    held = [numpy_helper.from_array(inputs[at], names[at]) for at in constants]
    node = helper.make_node(operator, names, made, name=name, **settings)
    # Kinds and shapes of outputs are those that the reference finds.
    unknown = [helper.make_tensor_value_info(n, TensorProto.FLOAT, None) for n in made]
    ports = [helper.make_tensor_value_info(n, element(v), v.shape) for n, v in given]
    opsets = [helper.make_opsetid("", 18)]
    model = helper.make_model(helper.make_graph([node], name, ports, unknown, held), opset_imports=opsets)
    found = ReferenceEvaluator(model).run(None, dict(given))
    found = [np.asarray(array, dtype=np.float32 if np.asarray(array).dtype.kind == "f" else np.int64) for array in found]
    outs = [helper.make_tensor_value_info(n, element(array), array.shape) for n, array in zip(made, found)]
    model = helper.make_model(helper.make_graph([node], name, ports, outs, held), opset_imports=opsets, ir_version=8)
    numbers = {"inputs": [told(value) for _, value in given], "outputs": [told(array) for array in found]}
    entry = model.metadata_props.add()
    entry.key, entry.value = "case", json.dumps(numbers)
    (FOLDER / f"{name}.onnx").write_bytes(model.SerializeToString())


def wholes(*numbers):
    return np.array(numbers, dtype=np.int64)


FOLDER.mkdir(parents=True, exist_ok=True)
for old in FOLDER.glob("*.onnx"):
    old.unlink()
for name in ["Abs", "Elu", "Erf", "Exp", "Identity", "LeakyRelu", "Neg", "Relu", "Sigmoid", "Softplus", "Tanh"]:
    case(name.lower(), name, [3 * floats(2, 5)])
case("log", "Log", [np.exp(floats(5))])
case("sqrt", "Sqrt", [np.abs(floats(5))])
for name in ["Add", "Div", "Max", "Min", "Mul", "Sub"]:
    case(name.lower(), name, [floats(2, 1, 3), floats(4, 1) + 3])
case("add_wholes", "Add", [wholes(1, 2, 3), wholes(5)])
case("pow", "Pow", [np.abs(floats(4)), np.float32([2, 0.5, 3, -1.2])])
case("clip", "Clip", [floats(8), np.float32(-0.5), np.float32(0.5)])
case("cast", "Cast", [np.arange(250, 256).astype(np.uint8)], to=TensorProto.FLOAT)
case("gemm", "Gemm", [floats(2, 3), floats(4, 3), floats(4)], alpha=0.5, beta=2.0, transB=1)
case("gemm_turned", "Gemm", [floats(3, 2), floats(3, 4)], transA=1)
case("matmul", "MatMul", [floats(2, 1, 3, 4), floats(5, 4, 2)])
case("matmul_vector", "MatMul", [floats(4), floats(4, 3)])
case("conv", "Conv", [floats(1, 4, 7, 6), floats(6, 2, 3, 3), floats(6)], group=2, strides=[2, 1], pads=[1, 0, 1, 2])
case("conv_same", "Conv", [floats(2, 1, 5, 5), floats(1, 1, 3, 2)], auto_pad="SAME_UPPER")
case("conv_row", "Conv", [floats(1, 2, 9), floats(3, 2, 3)], dilations=[2])
case("max_pool", "MaxPool", [floats(1, 2, 5, 5)], kernel_shape=[2, 3], strides=[2, 1], pads=[0, 1, 1, 1])
case("average_pool", "AveragePool", [floats(1, 2, 5, 5)], kernel_shape=[2, 2], strides=[2, 2], pads=[1, 0, 0, 1])
case("average_pool_all", "AveragePool", [floats(1, 1, 4, 4)], kernel_shape=[3, 3], pads=[1, 1, 1, 1], count_include_pad=1)
case("global_average_pool", "GlobalAveragePool", [floats(2, 3, 4, 5)])
scale, bias, mean, variance = floats(3), floats(3), floats(3), np.abs(floats(3)) + np.float32(0.1)
case("batch_normalization", "BatchNormalization", [floats(2, 3, 4), scale, bias, mean, variance], epsilon=1e-3)
case("layer_normalization", "LayerNormalization", [floats(2, 5), floats(5), floats(5)])
case("softmax", "Softmax", [floats(2, 3, 4)], axis=1)
case("reduce_mean", "ReduceMean", [floats(2, 3, 4), wholes(0, -1)], keepdims=0)
case("reduce_mean_all", "ReduceMean", [floats(2, 3)])
case("reshape", "Reshape", [floats(2, 3, 4), wholes(0, -1)])
case("flatten", "Flatten", [floats(2, 3, 4)], axis=-1)
case("transpose", "Transpose", [floats(2, 3, 4)], perm=[2, 0, 1])
case("concat", "Concat", [floats(2, 3), floats(2, 1), floats(2, 2)], axis=-1)
case("slice", "Slice", [floats(4, 6), wholes(-1, 1), wholes(-9, 99), wholes(0, 1), wholes(-2, 2)])
case("slice_plain", "Slice", [floats(5), wholes(1), wholes(-1)])
case("gather", "Gather", [floats(3, 4, 2), np.array([[0, -1], [2, 2]])], axis=1)
case("gather_wholes", "Gather", [wholes(7, 8, 9), np.array(1)])
case("squeeze", "Squeeze", [floats(1, 3, 1), wholes(0)])
case("unsqueeze", "Unsqueeze", [floats(3, 2), wholes(0, -1)])
case("split", "Split", [floats(2, 6), wholes(1, 5)], outputs=2, axis=1)
case("split_evenly", "Split", [floats(5)], outputs=2, num_outputs=2)
case("expand", "Expand", [floats(3, 1), wholes(2, 1, 4)])
case("shape", "Shape", [floats(3, 1, 2)], start=-2)
case("constant", "Constant", [], value=numpy_helper.from_array(floats(2, 2)))
case("constant_of_shape", "ConstantOfShape", [wholes(2, 3)], value=numpy_helper.from_array(np.float32([1.5])))
hidden, inputs = 3, 2
gru = [floats(4, 2, inputs), floats(1, 9, inputs), floats(1, 9, hidden), floats(1, 18), None, floats(1, 2, hidden)]
case("gru", "GRU", gru, outputs=2, constants=[1, 2, 3], hidden_size=hidden, linear_before_reset=1)
case("gru_early", "GRU", gru, outputs=2, constants=[1, 2, 3], hidden_size=hidden)
lstm = [floats(4, 2, inputs), floats(1, 12, inputs), floats(1, 12, hidden), floats(1, 24), None, floats(1, 2, hidden), floats(1, 2, hidden)]
case("lstm", "LSTM", lstm, outputs=2, constants=[1, 2, 3], hidden_size=hidden)
print(f"{len(list(FOLDER.glob('*.onnx')))} cases in {FOLDER}")
