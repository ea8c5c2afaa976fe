//! Layers with a memory, forward in time.

use super::elementwise::logistic;
use super::products::add_product_turned;
use crate::call::{Call, FUNCTION, Floats};
use crate::tensor::Tensor;

type Outcome = Result<Vec<Tensor>, String>;

/// A layer with a number of gates: sizes, weights, and the sums of a step.
struct Layer<'a> {
    steps: usize,
    batch: usize,
    inputs: usize,
    hidden: usize,
    gates: usize,
    sequence: &'a [f32],
    /// Weights of the inputs and of the memory: (gates x hidden, inputs), (gates x hidden, hidden).
    weights: [&'a [f32]; 2],
    /// Biases of both, gates x hidden each.
    biases: [Vec<f32>; 2],
}

impl<'a> Layer<'a> {
    fn of(call: &Call<'a>, gates: usize) -> Result<Self, String> {
        if call.text("direction", "forward")? != "forward" {
            return Err("its setting `direction` is not `forward`, which is read alone".to_owned());
        }
        call.only("layout", 0)?;
        if call.optional(4).is_some() {
            return Err("it has lengths of sequences, which are not read".to_owned());
        }
        let (shape, sequence): Floats<'a> = call.of_axes(0, 3)?;
        let [steps, batch, inputs] = [shape[0], shape[1], shape[2]];
        let hidden = call.of_axes(2, 3)?.0[2];
        let wide = gates.checked_mul(hidden).ok_or("its memory is too large")?;
        if usize::try_from(call.whole("hidden_size", hidden as i64)?) != Ok(hidden) {
            return Err(format!("its setting `hidden_size` is not {hidden}, the size of its weights"));
        }
        call.spend(&[steps, batch, wide, inputs])?;
        call.spend(&[steps, batch, wide, hidden])?;
        call.spend(&[steps, batch, wide, FUNCTION])?;
        // Sums of a step.
        call.room(&[batch, wide])?;
        let of_inputs = call.of_shape(1, &[1, wide, inputs])?;
        let of_hidden = call.of_shape(2, &[1, wide, hidden])?;
        let biases = match call.optional(3) {
            None => [vec![0.0; wide], vec![0.0; wide]],
            Some(_) => {
                let (one, other) = call.of_shape(3, &[1, 2 * wide])?.split_at(wide);
                [one.to_vec(), other.to_vec()]
            }
        };
        Ok(Self { steps, batch, inputs, hidden, gates, sequence, weights: [of_inputs, of_hidden], biases })
    }

    /// A memory that an input begins, or zeros.
    fn memory(&self, call: &Call<'_>, at: usize) -> Result<Vec<f32>, String> {
        let shape = [1, self.batch, self.hidden];
        let given = call.optional(at).map(|_| call.of_shape(at, &shape)).transpose()?;
        given.map_or_else(|| call.zeros(&shape), |given| Ok(given.to_vec()))
    }

    /// Sums of the inputs of a step: (batch, gates x hidden).
    fn of_inputs(&self, step: usize) -> Vec<f32> {
        let size = self.batch * self.inputs;
        self.sums(&self.sequence[step * size..][..size], 0, self.inputs)
    }

    /// Sums of a memory: (batch, gates x hidden).
    fn of_memory(&self, memory: &[f32]) -> Vec<f32> {
        self.sums(memory, 1, self.hidden)
    }

    fn sums(&self, values: &[f32], part: usize, inner: usize) -> Vec<f32> {
        let mut sums = self.biases[part].repeat(self.batch);
        add_product_turned(&mut sums, values, self.weights[part], inner, self.gates * self.hidden);
        sums
    }

    /// Place of a gate's sum for a number of the memory.
    fn gate(&self, gate: usize, at: usize) -> usize {
        (at / self.hidden * self.gates + gate) * self.hidden + at % self.hidden
    }

    /// Shapes of all memories and of the last.
    fn shapes(&self) -> [Vec<usize>; 2] {
        [vec![self.steps, 1, self.batch, self.hidden], vec![1, self.batch, self.hidden]]
    }
}

/// `GRU`: gates z, r, h.
pub fn gru(call: &Call<'_>) -> Outcome {
    let layer = Layer::of(call, 3)?;
    let resets_late = call.whole("linear_before_reset", 0)? != 0;
    let mut memory = layer.memory(call, 5)?;
    let [all_shape, last_shape] = layer.shapes();
    call.room(&all_shape)?;
    let mut all = vec![];
    for step in 0..layer.steps {
        let (own, kept) = (layer.of_inputs(step), layer.of_memory(&memory));
        let gate = |gate: usize, at: usize| logistic(own[layer.gate(gate, at)] + kept[layer.gate(gate, at)]);
        let count = memory.len();
        let new: Vec<f32> = match resets_late {
            true => (0..count).map(|at| own[layer.gate(2, at)] + gate(1, at) * kept[layer.gate(2, at)]).collect(),
            false => {
                call.spend(&[count, layer.gates * layer.hidden])?;
                let reset: Vec<f32> = (0..count).map(|at| gate(1, at) * memory[at]).collect();
                let kept = layer.of_memory(&reset);
                (0..count).map(|at| own[layer.gate(2, at)] + kept[layer.gate(2, at)]).collect()
            }
        };
        let next = (0..count).map(|at| (1.0 - gate(0, at)) * libm::tanhf(new[at]) + gate(0, at) * memory[at]);
        let next: Vec<f32> = next.collect();
        all.extend_from_slice(&next);
        memory = next;
    }
    Ok(vec![Tensor::floats(&all_shape, all), Tensor::floats(&last_shape, memory)])
}

/// `LSTM`: gates i, o, f, c.
pub fn lstm(call: &Call<'_>) -> Outcome {
    call.only("input_forget", 0)?;
    if call.optional(7).is_some() {
        return Err("it has peepholes, which are not read".to_owned());
    }
    let layer = Layer::of(call, 4)?;
    let (mut memory, mut cell) = (layer.memory(call, 5)?, layer.memory(call, 6)?);
    let [all_shape, last_shape] = layer.shapes();
    call.room(&all_shape)?;
    let mut all = vec![];
    for step in 0..layer.steps {
        let (own, kept) = (layer.of_inputs(step), layer.of_memory(&memory));
        let sum = |gate: usize, at: usize| own[layer.gate(gate, at)] + kept[layer.gate(gate, at)];
        for (at, cell) in cell.iter_mut().enumerate() {
            *cell = logistic(sum(2, at)) * *cell + logistic(sum(0, at)) * libm::tanhf(sum(3, at));
        }
        memory = (0..memory.len()).map(|at| logistic(sum(1, at)) * libm::tanhf(cell[at])).collect();
        all.extend_from_slice(&memory);
    }
    let [last, of_cell] = [memory, cell].map(|values| Tensor::floats(&last_shape, values));
    Ok(vec![Tensor::floats(&all_shape, all), last, of_cell])
}
