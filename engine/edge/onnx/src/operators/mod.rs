//! The operators: one entry each; each family has a file.
//!
//! To add one, write its function and add its entry to [`OPERATORS`].

mod convolution;
mod elementwise;
mod layout;
mod normalization;
mod parts;
mod pooling;
mod products;
mod recurrent;
mod shapes;
mod window;

use crate::call::Call;
use crate::tensor::Tensor;

/// Function of an operator: its outputs from its inputs.
pub type Run = fn(&Call<'_>) -> Result<Vec<Tensor>, String>;

/// An operator.
pub struct Operator {
    /// Name in files.
    pub name: &'static str,
    /// Settings that are read.
    pub attributes: &'static [&'static str],
    /// Its function.
    pub run: Run,
}

impl core::fmt::Debug for Operator {
    fn fmt(&self, to: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        to.write_str(self.name)
    }
}

const fn operator(name: &'static str, attributes: &'static [&'static str], run: Run) -> Operator {
    Operator { name, attributes, run }
}

/// Settings of windows that slide.
const CONV: &[&str] = &["auto_pad", "dilations", "group", "kernel_shape", "pads", "strides"];
const POOL: &[&str] =
    &["auto_pad", "ceil_mode", "count_include_pad", "dilations", "kernel_shape", "pads", "storage_order", "strides"];
/// Settings of layers with a memory.
const GRU: &[&str] = &["direction", "hidden_size", "layout", "linear_before_reset"];
const LSTM: &[&str] = &["direction", "hidden_size", "input_forget", "layout"];

/// All operators, sorted by name.
pub static OPERATORS: &[Operator] = &[
    operator("Abs", &[], elementwise::abs),
    operator("Add", &[], elementwise::add),
    operator("AveragePool", POOL, pooling::average),
    operator("BatchNormalization", &["epsilon", "momentum", "training_mode"], normalization::batch),
    operator("Cast", &["saturate", "to"], elementwise::cast),
    operator("Clip", &[], elementwise::clip),
    operator("Concat", &["axis"], parts::concat),
    operator("Constant", &["value", "value_float", "value_floats", "value_int", "value_ints"], layout::constant),
    operator("ConstantOfShape", &["value"], shapes::constant_of_shape),
    operator("Conv", CONV, convolution::conv),
    operator("Div", &[], elementwise::div),
    operator("Elu", &["alpha"], elementwise::elu),
    operator("Erf", &[], elementwise::erf),
    operator("Exp", &[], elementwise::exp),
    operator("Expand", &[], shapes::expand),
    operator("Flatten", &["axis"], layout::flatten),
    operator("GRU", GRU, recurrent::gru),
    operator("Gather", &["axis"], parts::gather),
    operator("Gemm", &["alpha", "beta", "transA", "transB"], products::gemm),
    operator("GlobalAveragePool", &[], pooling::global_average),
    operator("Identity", &[], layout::identity),
    operator("LSTM", LSTM, recurrent::lstm),
    operator("LayerNormalization", &["axis", "epsilon", "stash_type"], normalization::layer),
    operator("LeakyRelu", &["alpha"], elementwise::leaky_relu),
    operator("Log", &[], elementwise::log),
    operator("MatMul", &[], products::mat_mul),
    operator("Max", &[], elementwise::max),
    operator("MaxPool", POOL, pooling::max),
    operator("Min", &[], elementwise::min),
    operator("Mul", &[], elementwise::mul),
    operator("Neg", &[], elementwise::neg),
    operator("Pow", &[], elementwise::pow),
    operator("ReduceMean", &["axes", "keepdims", "noop_with_empty_axes"], normalization::reduce_mean),
    operator("Relu", &[], elementwise::relu),
    operator("Reshape", &["allowzero"], layout::reshape),
    operator("Shape", &["end", "start"], shapes::shape),
    operator("Sigmoid", &[], elementwise::sigmoid),
    operator("Slice", &[], parts::slice),
    operator("Softmax", &["axis"], normalization::softmax),
    operator("Softplus", &[], elementwise::softplus),
    operator("Split", &["axis", "num_outputs"], parts::split),
    operator("Sqrt", &[], elementwise::sqrt),
    operator("Squeeze", &[], layout::squeeze),
    operator("Sub", &[], elementwise::sub),
    operator("Tanh", &[], elementwise::tanh),
    operator("Transpose", &["perm"], layout::transpose),
    operator("Unsqueeze", &[], layout::unsqueeze),
];

#[cfg(test)]
mod tests {
    use super::OPERATORS;

    #[test]
    fn operators_and_their_settings_are_sorted() {
        assert!(OPERATORS.is_sorted_by_key(|operator| operator.name));
        assert!(OPERATORS.iter().all(|operator| operator.attributes.is_sorted()));
    }
}
