//! Products of matrices. Each sum runs over the inner axis in its order.

use super::shapes::{common, stretched};
use crate::call::Call;
use crate::tensor::Tensor;

type Outcome = Result<Vec<Tensor>, String>;

/// Adds the product of matrices (rows, inner) and (inner, columns) to `to`.
pub fn add_product(to: &mut [f32], a: &[f32], b: &[f32], inner: usize, columns: usize) {
    if inner == 0 || columns == 0 {
        return;
    }
    for (row, a) in to.chunks_exact_mut(columns).zip(a.chunks_exact(inner)) {
        for (a, b) in a.iter().zip(b.chunks_exact(columns)) {
            row.iter_mut().zip(b).for_each(|(to, b)| *to += a * b);
        }
    }
}

/// Adds the product of a matrix (rows, inner) and the transpose of one (columns, inner) to `to`. Several sums run side by side, each in
/// its order.
pub fn add_product_turned(to: &mut [f32], a: &[f32], b: &[f32], inner: usize, columns: usize) {
    if inner == 0 || columns == 0 {
        return;
    }
    for (row, a) in to.chunks_exact_mut(columns).zip(a.chunks_exact(inner)) {
        let (several, rest) = row.as_chunks_mut::<BESIDE>();
        let done = several.len() * BESIDE * inner;
        for (to, b) in several.iter_mut().zip(b.chunks_exact(BESIDE * inner)) {
            let rows: [&[f32]; BESIDE] = std::array::from_fn(|at| &b[at * inner..][..inner]);
            for (place, a) in a.iter().enumerate() {
                to.iter_mut().zip(rows).for_each(|(to, row)| *to += a * row[place]);
            }
        }
        for (to, b) in rest.iter_mut().zip(b[done..].chunks_exact(inner)) {
            a.iter().zip(b).for_each(|(a, b)| *to += a * b);
        }
    }
}

/// Sums that run side by side.
const BESIDE: usize = 8;

/// The transpose of a matrix.
pub fn transposed(values: &[f32], rows: usize, columns: usize) -> Vec<f32> {
    (0..columns).flat_map(|column| (0..rows).map(move |row| values[row * columns + column])).collect()
}

/// `Gemm`.
pub fn gemm(call: &Call<'_>) -> Outcome {
    let ((of_a, a), (own_b, b)) = (call.of_axes(0, 2)?, call.of_axes(1, 2)?);
    let [turns_a, turns_b] = [call.whole("transA", 0)? != 0, call.whole("transB", 0)? != 0];
    let sizes = |shape: &[usize], turns: bool| if turns { [shape[1], shape[0]] } else { [shape[0], shape[1]] };
    let ([rows, inner], [of_b, columns]) = (sizes(of_a, turns_a), sizes(own_b, turns_b));
    if inner != of_b {
        return Err(format!("it multiplies matrices of the shapes {:?} and {:?}", [rows, inner], [of_b, columns]));
    }
    let (alpha, beta) = (call.float("alpha", 1.0)?, call.float("beta", 1.0)?);
    let shape = [rows, columns];
    let mut values = call.zeros(&shape)?;
    call.spend(&[rows, inner, columns])?;
    call.spend(&[a.len()])?;
    let turned = turns_a.then(|| transposed(a, of_a[0], of_a[1]));
    let product = if turns_b { add_product_turned } else { add_product };
    product(&mut values, turned.as_deref().unwrap_or(a), b, inner, columns);
    if alpha != 1.0 {
        values.iter_mut().for_each(|value| *value *= alpha);
    }
    if call.optional(2).is_some() {
        let (own, added) = call.floats(2)?;
        if own.len() > 2 || common(own, &shape)? != shape {
            return Err(format!("it adds the shape {own:?} to {shape:?}"));
        }
        let places = stretched(own, &shape);
        values.iter_mut().zip(places).for_each(|(value, place)| *value += beta * added[place]);
    }
    Ok(vec![Tensor::floats(&shape, values)])
}

/// `MatMul`.
pub fn mat_mul(call: &Call<'_>) -> Outcome {
    let ((own_a, a), (own_b, b)) = (call.floats(0)?, call.floats(1)?);
    if own_a.is_empty() || own_b.is_empty() {
        return Err("it multiplies a single number".to_owned());
    }
    // Vectors are matrices of one row, or of one column.
    let shape_a = if own_a.len() == 1 { vec![1, own_a[0]] } else { own_a.to_vec() };
    let shape_b = if own_b.len() == 1 { vec![own_b[0], 1] } else { own_b.to_vec() };
    let (outer_a, [rows, inner]) = shape_a.split_last_chunk::<2>().ok_or("it multiplies no matrix")?;
    let (outer_b, [of_b, columns]) = shape_b.split_last_chunk::<2>().ok_or("it multiplies no matrix")?;
    if inner != of_b {
        return Err(format!("it multiplies the shapes {own_a:?} and {own_b:?}"));
    }
    let outer = common(outer_a, outer_b)?;
    let whole = [&outer[..], &[*rows, *columns]].concat();
    let mut values = call.zeros(&whole)?;
    call.spend(&[values.len(), *inner])?;
    let (size_a, size_b) = (rows * inner, inner * columns);
    let pairs = stretched(outer_a, &outer).zip(stretched(outer_b, &outer));
    for (to, (at_a, at_b)) in values.chunks_exact_mut((rows * columns).max(1)).zip(pairs) {
        add_product(to, &a[at_a * size_a..][..size_a], &b[at_b * size_b..][..size_b], *inner, *columns);
    }
    let mut shape = outer;
    shape.extend((own_a.len() > 1).then_some(*rows));
    shape.extend((own_b.len() > 1).then_some(*columns));
    Ok(vec![Tensor::floats(&shape, values)])
}
