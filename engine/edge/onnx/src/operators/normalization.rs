//! Means, deviations and shares along axes.

use super::elementwise::larger;
use crate::call::Call;
use crate::tensor::{Tensor, places, strides};

type Outcome = Result<Vec<Tensor>, String>;

/// `BatchNormalization`, with the means and variances of the file.
pub fn batch(call: &Call<'_>) -> Outcome {
    call.only("training_mode", 0)?;
    let (shape, values) = call.floats(0)?;
    let channels =
        *shape.get(1).ok_or_else(|| format!("its input has the shape {shape:?}; it must have 2 axes or more"))?;
    let of = |at: usize| call.of_shape(at, &[channels]);
    let (scale, bias, mean, variance) = (of(1)?, of(2)?, of(3)?, of(4)?);
    let epsilon = call.float("epsilon", 1e-5)?;
    call.room(shape)?;
    let pixels: usize = shape[2..].iter().product::<usize>().max(1);
    let normal = |(at, value): (usize, &f32)| {
        let channel = at / pixels % channels;
        (value - mean[channel]) / (variance[channel] + epsilon).sqrt() * scale[channel] + bias[channel]
    };
    Ok(vec![Tensor::floats(shape, values.iter().enumerate().map(normal).collect())])
}

/// `LayerNormalization`.
pub fn layer(call: &Call<'_>) -> Outcome {
    call.only("stash_type", 1)?;
    let (shape, values) = call.floats(0)?;
    let axis = call.axis(call.whole("axis", -1)?, shape.len())?;
    let scale = call.of_shape(1, &shape[axis..])?;
    let bias = call.optional(2).map(|_| call.of_shape(2, &shape[axis..])).transpose()?;
    let epsilon = call.float("epsilon", 1e-5)?;
    call.room(shape)?;
    let mut out = Vec::with_capacity(values.len());
    for row in values.chunks_exact(scale.len().max(1)) {
        let count = row.len() as f32;
        let mean = row.iter().sum::<f32>() / count;
        let variance = row.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>() / count;
        let deviation = (variance + epsilon).sqrt();
        out.extend(
            row.iter()
                .enumerate()
                .map(|(at, value)| (value - mean) / deviation * scale[at] + bias.map_or(0.0, |bias| bias[at])),
        );
    }
    Ok(vec![Tensor::floats(shape, out)])
}

/// `Softmax`.
pub fn softmax(call: &Call<'_>) -> Outcome {
    let (shape, values) = call.floats(0)?;
    let axis = call.axis(call.whole("axis", -1)?, shape.len())?;
    call.functions(shape)?;
    let (size, step) = (shape[axis], strides(shape)[axis]);
    let mut out = values.to_vec();
    for first in (0..values.len()).filter(|at| at / step % size == 0) {
        let places = || (0..size).map(|at| first + at * step);
        let largest = places().map(|place| values[place]).fold(f32::NEG_INFINITY, larger);
        places().for_each(|place| out[place] = libm::expf(values[place] - largest));
        let sum: f32 = places().map(|place| out[place]).sum();
        places().for_each(|place| out[place] /= sum);
    }
    Ok(vec![Tensor::floats(shape, out)])
}

/// `ReduceMean`.
pub fn reduce_mean(call: &Call<'_>) -> Outcome {
    let (shape, values) = call.floats(0)?;
    let stated = match call.wholes(1)? {
        Some(axes) => Some(axes),
        None => call.list("axes")?,
    };
    let stated = stated.filter(|axes| !axes.is_empty());
    let is_mean = match stated {
        None => vec![call.whole("noop_with_empty_axes", 0)? == 0; shape.len()],
        Some(axes) => {
            let axes = axes.iter().map(|axis| call.axis(*axis, shape.len())).collect::<Result<Vec<_>, _>>()?;
            (0..shape.len()).map(|axis| axes.contains(&axis)).collect()
        }
    };
    let own = strides(shape);
    let (mut outer, mut inner) = ((vec![], vec![]), (vec![], vec![]));
    for axis in 0..shape.len() {
        let (sizes, steps) = if is_mean[axis] { &mut inner } else { &mut outer };
        sizes.push(shape[axis]);
        steps.push(own[axis] as isize);
    }
    call.spend(&[values.len()])?;
    let keeps = call.whole("keepdims", 1)? != 0;
    let kept = (0..shape.len()).filter(|axis| keeps || !is_mean[*axis]);
    let kept: Vec<usize> = kept.map(|axis| if is_mean[axis] { 1 } else { shape[axis] }).collect();
    call.room(&kept)?;
    let count = inner.0.iter().product::<usize>() as f32;
    let mean = |first: usize| places(&inner.0, &inner.1, first).map(|place| values[place]).sum::<f32>() / count;
    Ok(vec![Tensor::floats(&kept, places(&outer.0, &outer.1, 0).map(mean).collect())])
}
