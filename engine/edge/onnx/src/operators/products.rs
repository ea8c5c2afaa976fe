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

/// The transpose of a matrix.
pub fn transposed(values: &[f32], rows: usize, columns: usize) -> Vec<f32> {
    (0..columns).flat_map(|column| (0..rows).map(move |row| values[row * columns + column])).collect()
}

/// `Gemm`.
pub fn gemm(call: &Call<'_>) -> Outcome {
    let matrix = |at: usize, turned: &str| -> Result<([usize; 2], Vec<f32>), String> {
        let (shape, values) = call.of_axes(at, 2)?;
        call.spend(&[values.len()])?;
        Ok(match call.whole(turned, 0)? {
            0 => ([shape[0], shape[1]], values.to_vec()),
            _ => ([shape[1], shape[0]], transposed(values, shape[0], shape[1])),
        })
    };
    let (([rows, inner], a), ([of_b, columns], b)) = (matrix(0, "transA")?, matrix(1, "transB")?);
    if inner != of_b {
        return Err(format!("it multiplies matrices of the shapes {:?} and {:?}", [rows, inner], [of_b, columns]));
    }
    let (alpha, beta) = (call.float("alpha", 1.0)?, call.float("beta", 1.0)?);
    let shape = [rows, columns];
    let mut values = call.zeros(&shape)?;
    call.spend(&[rows, inner, columns])?;
    add_product(&mut values, &a, &b, inner, columns);
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
