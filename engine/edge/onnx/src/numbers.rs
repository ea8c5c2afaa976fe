//! Numbers of a file: constants, and settings that are tensors.

use crate::tensor::{Kind, MOST_AXES, MOST_NUMBERS, Tensor, count};
use crate::wire::{Field, fields};

/// Reads a message `TensorProto`: its name and its numbers.
pub fn tensor(bytes: &[u8]) -> Result<(String, Tensor), String> {
    let (mut name, mut element, mut sizes) = (String::new(), 0, vec![]);
    let (mut floats, mut wholes, mut raw) = (vec![], vec![], None);
    for field in fields(bytes) {
        match field? {
            (1, field) => field.wholes(&mut sizes, MOST_AXES)?,
            (2, field) => element = field.whole()?,
            (4, field) => field.floats(&mut floats, MOST_NUMBERS)?,
            (5 | 7, field) => field.wholes(&mut wholes, MOST_NUMBERS)?,
            (8, field) => name = field.text()?.to_owned(),
            (9, field) => raw = Some(field.bytes()?),
            (13, _) | (14, Field::Number(1)) => {
                return Err(format!("`{name}` lies in another file: save the network as one file"));
            }
            _ => {}
        }
    }
    let kind = Kind::of(element).map_err(|what| format!("`{name}`: {what}"))?;
    if let Some(raw) = raw {
        match kind {
            Kind::Float => floats = raw.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect(),
            Kind::Whole => wholes = raw_wholes(raw, element),
        }
    }
    let sizes = sizes.iter().map(|size| usize::try_from(*size).ok()).collect::<Option<Vec<usize>>>();
    let sizes = sizes.ok_or_else(|| format!("`{name}` has a negative size"))?;
    let values = match kind {
        Kind::Float => Tensor::floats(&sizes, floats),
        Kind::Whole => Tensor::wholes(&sizes, wholes),
    };
    if count(&sizes) != Some(values.values.len()) {
        return Err(format!("`{name}` has the shape {sizes:?} and {} numbers", values.values.len()));
    }
    Ok((name, values))
}

/// Whole numbers of an element type, as they lie in memory.
fn raw_wholes(raw: &[u8], element: i64) -> Vec<i64> {
    match element {
        6 => raw.as_chunks().0.iter().map(|bytes| i64::from(i32::from_le_bytes(*bytes))).collect(),
        7 => raw.as_chunks().0.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect(),
        3 => raw.iter().map(|byte| i64::from(byte.cast_signed())).collect(),
        _ => raw.iter().map(|byte| i64::from(*byte)).collect(),
    }
}
