//! Operators that give the same numbers another shape or order.

use super::shapes::sizes;
use crate::attributes::Attribute;
use crate::call::Call;
use crate::tensor::{MOST_AXES, Tensor, listed, places, strides};

type Outcome = Result<Vec<Tensor>, String>;

fn reshaped(call: &Call<'_>, shape: Vec<usize>) -> Outcome {
    call.room(&shape)?;
    Ok(vec![Tensor { shape, values: call.input(0)?.values.clone() }])
}

/// `Constant`.
pub fn constant(call: &Call<'_>) -> Outcome {
    let tensor = match call.attributes.iter().next() {
        Some((_, Attribute::Tensor(tensor))) => tensor.clone(),
        Some((_, Attribute::Float(value))) => Tensor::floats(&[], vec![*value]),
        Some((_, Attribute::Floats(values))) => Tensor::floats(&[values.len()], values.clone()),
        Some((_, Attribute::Whole(value))) => Tensor::wholes(&[], vec![*value]),
        Some((_, Attribute::Wholes(values))) => Tensor::wholes(&[values.len()], values.clone()),
        _ => return Err("it has no value of a kind that is read".to_owned()),
    };
    call.room(&tensor.shape)?;
    Ok(vec![tensor])
}

/// `Identity`.
pub fn identity(call: &Call<'_>) -> Outcome {
    reshaped(call, call.input(0)?.shape.clone())
}

/// `Flatten`.
pub fn flatten(call: &Call<'_>) -> Outcome {
    let shape = &call.input(0)?.shape;
    let axis = call.whole("axis", 1)?;
    let counted = if axis < 0 { axis + shape.len() as i64 } else { axis };
    let axis = usize::try_from(counted).ok().filter(|axis| *axis <= shape.len());
    let axis = axis.ok_or_else(|| format!("it has the axis {counted} of the shape {shape:?}"))?;
    reshaped(call, vec![shape[..axis].iter().product(), shape[axis..].iter().product()])
}

/// `Reshape`.
pub fn reshape(call: &Call<'_>) -> Outcome {
    let (input, wanted) = (call.input(0)?, call.wholes(1)?.ok_or("its shape is missing")?);
    let keeps = call.whole("allowzero", 0)? == 0;
    let mut shape = vec![];
    for (at, size) in wanted.iter().enumerate() {
        shape.push(match size {
            0 if keeps => *input.shape.get(at).ok_or("its shape keeps an axis that is not there")? as i64,
            size => *size,
        });
    }
    let count = input.values.len();
    let unfit = || format!("{count} numbers do not fit the shape {}", listed(wanted));
    if let Some(open) = shape.iter().position(|size| *size == -1) {
        shape[open] = 1;
        let others = sizes(&shape)?.iter().try_fold(1_usize, |product, size| product.checked_mul(*size));
        let others = others.filter(|others| *others > 0 && count % others == 0);
        shape[open] = (count / others.ok_or_else(unfit)?) as i64;
    }
    let shape = sizes(&shape)?;
    let fits = shape.iter().try_fold(1_usize, |product, size| product.checked_mul(*size)) == Some(count);
    if fits { reshaped(call, shape) } else { Err(unfit()) }
}

/// `Squeeze`.
pub fn squeeze(call: &Call<'_>) -> Outcome {
    let shape = &call.input(0)?.shape;
    let axes = call.wholes(1)?.map(|axes| axes.iter().map(|axis| call.axis(*axis, shape.len())).collect());
    let axes: Option<Vec<usize>> = axes.transpose()?;
    let is_gone = |axis: usize| axes.as_ref().map_or(shape[axis] == 1, |axes| axes.contains(&axis));
    if let Some(axis) = (0..shape.len()).find(|axis| is_gone(*axis) && shape[*axis] != 1) {
        return Err(format!("it takes away the axis {axis} of the shape {shape:?}, whose size is not 1"));
    }
    reshaped(call, (0..shape.len()).filter(|axis| !is_gone(*axis)).map(|axis| shape[axis]).collect())
}

/// `Unsqueeze`.
pub fn unsqueeze(call: &Call<'_>) -> Outcome {
    let (shape, axes) = (&call.input(0)?.shape, call.wholes(1)?.ok_or("its axes are missing")?);
    let all = shape.len() + axes.len();
    if all > MOST_AXES {
        return Err(format!("its result has {all} axes; a tensor may have {MOST_AXES}"));
    }
    let mut new = axes.iter().map(|axis| call.axis(*axis, all)).collect::<Result<Vec<usize>, _>>()?;
    new.sort_unstable();
    new.dedup();
    if new.len() != axes.len() {
        return Err(format!("its axes {axes:?} name one twice"));
    }
    let mut old = shape.iter().copied();
    reshaped(call, (0..all).map(|axis| if new.contains(&axis) { 1 } else { old.next().unwrap_or(1) }).collect())
}

/// `Transpose`.
pub fn transpose(call: &Call<'_>) -> Outcome {
    let input = call.input(0)?;
    let axes = input.shape.len();
    let order = match call.list("perm")? {
        None => (0..axes).rev().collect(),
        Some(order) => sizes(order)?,
    };
    let mut sorted = order.clone();
    sorted.sort_unstable();
    if !sorted.into_iter().eq(0..axes) {
        return Err(format!("its order {} does not name each of {axes} axes once", listed(&order)));
    }
    let steps = strides(&input.shape);
    let shape: Vec<usize> = order.iter().map(|axis| input.shape[*axis]).collect();
    call.room(&shape)?;
    let steps: Vec<isize> = order.iter().map(|axis| steps[*axis] as isize).collect();
    let values = input.values.pick(places(&shape, &steps, 0));
    Ok(vec![Tensor { shape, values }])
}
