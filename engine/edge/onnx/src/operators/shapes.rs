//! Shapes that fit together: broadcasting, and shapes as numbers.

use crate::attributes::Attribute;
use crate::call::Call;
use crate::tensor::{Tensor, listed, places, strides};

/// The shape to which two shapes are stretched.
pub fn common(a: &[usize], b: &[usize]) -> Result<Vec<usize>, String> {
    let axes = a.len().max(b.len());
    let size = |shape: &[usize], axis: usize| (axis + shape.len()).checked_sub(axes).map_or(1, |axis| shape[axis]);
    let fit = |axis: usize| match (size(a, axis), size(b, axis)) {
        (a, b) if a == b || b == 1 => Some(a),
        (1, b) => Some(b),
        _ => None,
    };
    let shape = (0..axes).map(fit).collect::<Option<_>>();
    shape.ok_or_else(|| format!("the shapes {} and {} do not fit together", listed(a), listed(b)))
}

/// Places of a tensor's numbers where it is stretched to a shape.
pub fn stretched(shape: &[usize], to: &[usize]) -> impl Iterator<Item = usize> + use<> {
    let mut steps = vec![0; to.len() - shape.len()];
    steps.extend(strides(shape).iter().zip(shape).map(|(step, size)| if *size == 1 { 0 } else { *step as isize }));
    places(to, &steps, 0)
}

/// `Expand`.
pub fn expand(call: &Call<'_>) -> Result<Vec<Tensor>, String> {
    let input = call.input(0)?;
    let shape = common(&input.shape, &sizes(call.wholes(1)?.ok_or("its shape is missing")?)?)?;
    call.room(&shape)?;
    let values = input.values.pick(stretched(&input.shape, &shape));
    Ok(vec![Tensor { shape, values }])
}

/// `Shape`.
pub fn shape(call: &Call<'_>) -> Result<Vec<Tensor>, String> {
    let shape = &call.input(0)?.shape;
    let axes = shape.len() as i64;
    let bound = |at: i64| (if at < 0 { at.saturating_add(axes) } else { at }).clamp(0, axes) as usize;
    let (start, end) = (bound(call.whole("start", 0)?), bound(call.whole("end", axes)?));
    let sizes: Vec<i64> = shape.get(start..end).unwrap_or_default().iter().map(|size| *size as i64).collect();
    Ok(vec![Tensor::wholes(&[sizes.len()], sizes)])
}

/// `ConstantOfShape`.
pub fn constant_of_shape(call: &Call<'_>) -> Result<Vec<Tensor>, String> {
    let shape = sizes(call.wholes(0)?.ok_or("its shape is missing")?)?;
    let count = call.room(&shape)?;
    let value = match call.attributes.get("value") {
        None => Tensor::floats(&[1], vec![0.0]),
        Some(Attribute::Tensor(tensor)) if tensor.values.len() == 1 => tensor.clone(),
        Some(_) => return Err("its setting `value` must be a tensor of one number".to_owned()),
    };
    Ok(vec![Tensor { shape, values: value.values.pick(std::iter::repeat_n(0, count)) }])
}

/// Sizes that whole numbers state.
pub fn sizes(numbers: &[i64]) -> Result<Vec<usize>, String> {
    let size = |number: &i64| usize::try_from(*number).map_err(|_| format!("{number} is no size of an axis"));
    numbers.iter().map(size).collect()
}
