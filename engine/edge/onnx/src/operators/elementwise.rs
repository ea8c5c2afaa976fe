//! Operators on each number, and on pairs of numbers.

use super::shapes::{common, stretched};
use crate::call::Call;
use crate::tensor::{Kind, Tensor, TensorValues};

type Outcome = Result<Vec<Tensor>, String>;

/// A function on each float.
fn each(call: &Call<'_>, function: impl Fn(f32) -> f32) -> Outcome {
    let (shape, values) = call.floats(0)?;
    call.room(shape)?;
    Ok(vec![Tensor::floats(shape, values.iter().map(|value| function(*value)).collect())])
}

/// A function that takes long, on each float.
fn each_long(call: &Call<'_>, function: impl Fn(f32) -> f32) -> Outcome {
    call.functions(call.floats(0)?.0)?;
    each(call, function)
}

/// `Abs`.
pub fn abs(call: &Call<'_>) -> Outcome {
    each(call, f32::abs)
}

/// `Elu`.
pub fn elu(call: &Call<'_>) -> Outcome {
    let alpha = call.float("alpha", 1.0)?;
    each_long(call, |x| if x < 0.0 { alpha * (libm::expf(x) - 1.0) } else { x })
}

/// `Erf`.
pub fn erf(call: &Call<'_>) -> Outcome {
    each_long(call, libm::erff)
}

/// `Exp`.
pub fn exp(call: &Call<'_>) -> Outcome {
    each_long(call, libm::expf)
}

/// `LeakyRelu`.
pub fn leaky_relu(call: &Call<'_>) -> Outcome {
    let alpha = call.float("alpha", 0.01)?;
    each(call, |x| if x < 0.0 { alpha * x } else { x })
}

/// `Log`.
pub fn log(call: &Call<'_>) -> Outcome {
    each_long(call, libm::logf)
}

/// `Neg`.
pub fn neg(call: &Call<'_>) -> Outcome {
    each(call, |x| -x)
}

/// `Relu`.
pub fn relu(call: &Call<'_>) -> Outcome {
    each(call, |x| if x < 0.0 { 0.0 } else { x })
}

/// `Sigmoid`.
pub fn sigmoid(call: &Call<'_>) -> Outcome {
    each_long(call, logistic)
}

/// `Softplus`.
pub fn softplus(call: &Call<'_>) -> Outcome {
    each_long(call, |x| larger(x, 0.0) + libm::log1pf(libm::expf(-x.abs())))
}

/// `Sqrt`.
pub fn sqrt(call: &Call<'_>) -> Outcome {
    each(call, f32::sqrt)
}

/// `Tanh`.
pub fn tanh(call: &Call<'_>) -> Outcome {
    each_long(call, libm::tanhf)
}

/// The logistic function.
pub fn logistic(x: f32) -> f32 {
    1.0 / (1.0 + libm::expf(-x))
}

/// The larger of two numbers; unlike `f32::max` it says which of the two zeros.
pub fn larger(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}

/// The smaller of two numbers.
pub fn smaller(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// A function on pairs of numbers of two tensors, stretched to a common shape.
fn paired(
    call: &Call<'_>,
    [a, b]: [&Tensor; 2],
    floats: fn(f32, f32) -> f32,
    wholes: fn(i64, i64) -> Option<i64>,
) -> Result<Tensor, String> {
    let shape = common(&a.shape, &b.shape)?;
    call.room(&shape)?;
    let places = || stretched(&a.shape, &shape).zip(stretched(&b.shape, &shape));
    let values = match (&a.values, &b.values) {
        (TensorValues::Floats(one), TensorValues::Floats(other)) if a.shape == b.shape => {
            TensorValues::Floats(one.iter().zip(other).map(|(one, other)| floats(*one, *other)).collect())
        }
        (TensorValues::Floats(one), TensorValues::Floats(other)) => {
            TensorValues::Floats(places().map(|(at, with)| floats(one[at], other[with])).collect())
        }
        (TensorValues::Wholes(one), TensorValues::Wholes(other)) => {
            let whole = places().map(|(at, with)| wholes(one[at], other[with])).collect::<Option<_>>();
            TensorValues::Wholes(whole.ok_or("its whole numbers become too large, or are divided by 0")?)
        }
        _ => return Err("it has floats and whole numbers; both must be of one kind".to_owned()),
    };
    Ok(Tensor { shape, values })
}

fn pair(call: &Call<'_>, floats: fn(f32, f32) -> f32, wholes: fn(i64, i64) -> Option<i64>) -> Outcome {
    Ok(vec![paired(call, [call.input(0)?, call.input(1)?], floats, wholes)?])
}

/// `Add`.
pub fn add(call: &Call<'_>) -> Outcome {
    pair(call, |a, b| a + b, i64::checked_add)
}

/// `Sub`.
pub fn sub(call: &Call<'_>) -> Outcome {
    pair(call, |a, b| a - b, i64::checked_sub)
}

/// `Mul`.
pub fn mul(call: &Call<'_>) -> Outcome {
    pair(call, |a, b| a * b, i64::checked_mul)
}

/// `Div`.
pub fn div(call: &Call<'_>) -> Outcome {
    pair(call, |a, b| a / b, i64::checked_div)
}

/// `Pow`.
pub fn pow(call: &Call<'_>) -> Outcome {
    call.functions(&common(&call.input(0)?.shape, &call.input(1)?.shape)?)?;
    pair(call, power, |a, b| a.checked_pow(u32::try_from(b).ok()?))
}

/// A power; squares and roots to the last bit.
fn power(base: f32, exponent: f32) -> f32 {
    match exponent {
        2.0 => base * base,
        0.5 => base.sqrt(),
        _ => libm::powf(base, exponent),
    }
}

/// A function on pairs, over all inputs from the first to the last.
fn folded(call: &Call<'_>, floats: fn(f32, f32) -> f32, wholes: fn(i64, i64) -> Option<i64>) -> Outcome {
    let mut folded = call.input(0)?.clone();
    for at in 1..call.inputs.len() {
        folded = paired(call, [&folded, call.input(at)?], floats, wholes)?;
    }
    Ok(vec![folded])
}

/// `Max`.
pub fn max(call: &Call<'_>) -> Outcome {
    folded(call, larger, |a, b| Some(a.max(b)))
}

/// `Min`.
pub fn min(call: &Call<'_>) -> Outcome {
    folded(call, smaller, |a, b| Some(a.min(b)))
}

/// `Clip`.
pub fn clip(call: &Call<'_>) -> Outcome {
    let bound = |at: usize| match call.optional(at) {
        None => Ok(None),
        Some(_) => match call.floats(at)? {
            (_, [bound]) => Ok(Some(*bound)),
            (shape, _) => Err(format!("its bound has the shape {shape:?}; it must be one number")),
        },
    };
    let (low, high) = (bound(1)?, bound(2)?);
    each(call, |x| {
        let x = low.map_or(x, |low| larger(x, low));
        high.map_or(x, |high| smaller(x, high))
    })
}

/// `Cast`.
pub fn cast(call: &Call<'_>) -> Outcome {
    let (input, to) = (call.input(0)?, call.whole("to", 0)?);
    call.room(&input.shape)?;
    let values = match (&input.values, Kind::of(to)?) {
        (TensorValues::Floats(values), Kind::Float) => TensorValues::Floats(values.clone()),
        (TensorValues::Wholes(values), Kind::Float) => {
            TensorValues::Floats(values.iter().map(|value| *value as f32).collect())
        }
        (TensorValues::Floats(values), Kind::Whole) if to == 9 => {
            TensorValues::Wholes(values.iter().map(|value| i64::from(*value != 0.0)).collect())
        }
        (TensorValues::Floats(values), Kind::Whole) => {
            TensorValues::Wholes(values.iter().map(|value| within(*value as i64, to)).collect())
        }
        (TensorValues::Wholes(values), Kind::Whole) => {
            TensorValues::Wholes(values.iter().map(|value| within(*value, to)).collect())
        }
    };
    Ok(vec![Tensor { shape: input.shape.clone(), values }])
}

/// A whole number as its element type holds it.
fn within(value: i64, element: i64) -> i64 {
    match element {
        2 => i64::from(value as u8),
        3 => i64::from(value as i8),
        6 => i64::from(value as i32),
        9 => i64::from(value != 0),
        _ => value,
    }
}
