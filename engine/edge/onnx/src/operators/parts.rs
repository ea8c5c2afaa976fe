//! Operators that take parts of tensors and put them together.

use super::shapes::sizes;
use crate::call::Call;
use crate::tensor::{Tensor, TensorValues, listed, places, strides};

type Outcome = Result<Vec<Tensor>, String>;

/// `Concat`.
pub fn concat(call: &Call<'_>) -> Outcome {
    let first = call.input(0)?;
    let axis = call.axis(call.whole("axis", i64::MAX)?, first.shape.len())?;
    let tensors = (0..call.inputs.len()).map(|at| call.input(at)).collect::<Result<Vec<_>, _>>()?;
    let mut shape = first.shape.clone();
    shape[axis] = 0;
    for tensor in &tensors {
        let others =
            |shape: &[usize]| shape.iter().enumerate().filter(|it| it.0 != axis).map(|it| *it.1).collect::<Vec<_>>();
        let fits = tensor.shape.len() == shape.len() && others(&tensor.shape) == others(&first.shape);
        if !fits || tensor.values.kind() != first.values.kind() {
            return Err(format!("it puts the shapes {:?} and {:?} together", first.shape, tensor.shape));
        }
        shape[axis] += tensor.shape[axis];
    }
    call.room(&shape)?;
    let outer: usize = shape[..axis].iter().product();
    call.spend(&[outer, tensors.len()])?;
    let blocks = |tensor: &Tensor| tensor.shape[axis..].iter().product::<usize>();
    let mut values = match first.values {
        TensorValues::Floats(_) => TensorValues::Floats(vec![]),
        TensorValues::Wholes(_) => TensorValues::Wholes(vec![]),
    };
    for row in 0..outer {
        for tensor in &tensors {
            let range = row * blocks(tensor)..(row + 1) * blocks(tensor);
            match (&mut values, &tensor.values) {
                (TensorValues::Floats(to), TensorValues::Floats(from)) => to.extend_from_slice(&from[range]),
                (TensorValues::Wholes(to), TensorValues::Wholes(from)) => to.extend_from_slice(&from[range]),
                _ => {}
            }
        }
    }
    Ok(vec![Tensor { shape, values }])
}

/// A part of a tensor: along each axis the first place, the step, and the count.
fn part(call: &Call<'_>, input: &Tensor, along: &[(usize, isize, usize)]) -> Result<Tensor, String> {
    let shape: Vec<usize> = along.iter().map(|it| it.2).collect();
    call.room(&shape)?;
    let own = strides(&input.shape);
    let first = along.iter().zip(&own).map(|(it, step)| it.0 * step).sum();
    let steps: Vec<isize> = along.iter().zip(&own).map(|(it, step)| it.1 * *step as isize).collect();
    let values = input.values.pick(places(&shape, &steps, first));
    Ok(Tensor { shape, values })
}

fn whole(input: &Tensor) -> Vec<(usize, isize, usize)> {
    input.shape.iter().map(|size| (0, 1, *size)).collect()
}

/// `Slice`.
pub fn slice(call: &Call<'_>) -> Outcome {
    let input = call.input(0)?;
    let (starts, ends) =
        (call.wholes(1)?.ok_or("its starts are missing")?, call.wholes(2)?.ok_or("its ends are missing")?);
    let all: Vec<i64> = (0..starts.len() as i64).collect();
    let ones = vec![1; starts.len()];
    let (axes, steps) = (call.wholes(3)?.unwrap_or(&all), call.wholes(4)?.unwrap_or(&ones));
    if [ends.len(), axes.len(), steps.len()].iter().any(|length| *length != starts.len()) {
        return Err("its starts, ends, axes and steps have different lengths".to_owned());
    }
    let mut along = whole(input);
    for at in 0..starts.len() {
        let axis = call.axis(axes[at], input.shape.len())?;
        let (size, step) = (input.shape[axis] as i64, steps[at]);
        if step == 0 || step == i64::MIN {
            return Err(format!("its step is {step}"));
        }
        let counted = |place: i64| if place < 0 { place.saturating_add(size) } else { place };
        let (first, count) = match step > 0 {
            true => {
                let (first, end) = (counted(starts[at]).clamp(0, size), counted(ends[at]).clamp(0, size));
                (first, (end - first).max(0).div_ceil_by(step))
            }
            false => {
                let first = counted(starts[at]).clamp((size - 1).min(0), size - 1);
                let end = counted(ends[at]).clamp(-1, size - 1);
                (first.max(0), (first - end).max(0).div_ceil_by(-step))
            }
        };
        // A single place is reached by no step.
        let step = if count > 1 { step as isize } else { 0 };
        along[axis] = (first as usize, step, count as usize);
    }
    Ok(vec![part(call, input, &along)?])
}

trait DivCeil {
    /// The quotient of numbers above 0, rounded up.
    fn div_ceil_by(self, by: i64) -> i64;
}

impl DivCeil for i64 {
    fn div_ceil_by(self, by: i64) -> i64 {
        self / by + i64::from(self % by != 0)
    }
}

/// `Split`.
pub fn split(call: &Call<'_>) -> Outcome {
    let input = call.input(0)?;
    let axis = call.axis(call.whole("axis", 0)?, input.shape.len())?;
    let (size, parts) = (input.shape[axis], call.outputs);
    let lengths = match call.wholes(1)? {
        Some(lengths) => sizes(lengths)?,
        None => {
            let each = size.div_ceil(parts.max(1));
            (0..parts).map(|at| each.min(size.saturating_sub(at * each))).collect()
        }
    };
    if lengths.len() != parts || lengths.iter().try_fold(0_usize, |sum, it| sum.checked_add(*it)) != Some(size) {
        return Err(format!("it splits an axis of the size {size} into {} for {parts} outputs", listed(&lengths)));
    }
    let mut from = 0;
    let one = |length: usize| {
        let mut along = whole(input);
        along[axis] = (from, 1, length);
        from += length;
        part(call, input, &along)
    };
    lengths.into_iter().map(one).collect()
}

/// `Gather`.
pub fn gather(call: &Call<'_>) -> Outcome {
    let (input, places) = (call.input(0)?, call.input(1)?);
    let axis = call.axis(call.whole("axis", 0)?, input.shape.len())?;
    let (size, wanted) = (input.shape[axis], call.wholes(1)?.ok_or("its places are missing")?);
    let taken = wanted.iter().map(|place| call.axis(*place, size)).collect::<Result<Vec<usize>, _>>();
    let taken = taken.map_err(|_| format!("it takes the places {} of an axis of the size {size}", listed(wanted)))?;
    let (before, after) = (&input.shape[..axis], &input.shape[axis + 1..]);
    let shape = [before, &places.shape, after].concat();
    call.room(&shape)?;
    let (outer, inner): (usize, usize) = (before.iter().product(), after.iter().product());
    let row = |outer: usize| {
        let taken = &taken;
        taken.iter().flat_map(move |place| (outer * size + place) * inner..(outer * size + place + 1) * inner)
    };
    let values = input.values.pick((0..outer).flat_map(row));
    Ok(vec![Tensor { shape, values }])
}
