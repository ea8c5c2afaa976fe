//! [`Attribute`]: a setting of a node.

use crate::numbers::tensor;
use crate::tensor::Tensor;
use crate::wire::{fields, push};

/// Most numbers of a setting.
const MOST_NUMBERS: usize = 1 << 12;

/// A setting of a node.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// A number.
    Float(f32),
    /// A whole number.
    Whole(i64),
    /// A text.
    Text(String),
    /// Numbers with a shape.
    Tensor(Tensor),
    /// Numbers.
    Floats(Vec<f32>),
    /// Whole numbers.
    Wholes(Vec<i64>),
    /// Texts.
    Texts(Vec<String>),
}

/// Reads a message `AttributeProto`: its name and its value.
pub fn read(bytes: &[u8]) -> Result<(String, Attribute), String> {
    let (mut name, mut kind) = (String::new(), 0);
    let (mut float, mut whole, mut text, mut numbers) = (0.0, 0, String::new(), None);
    let (mut floats, mut wholes, mut texts) = (vec![], vec![], vec![]);
    for field in fields(bytes) {
        match field? {
            (1, field) => name = field.text()?.to_owned(),
            (2, field) => float = field.float()?,
            (3, field) => whole = field.whole()?,
            (4, field) => text = field.text()?.to_owned(),
            (5, field) => numbers = Some(tensor(field.bytes()?)?.1),
            (7, field) => field.floats(&mut floats, MOST_NUMBERS)?,
            (8, field) => field.wholes(&mut wholes, MOST_NUMBERS)?,
            (9, field) => push(&mut texts, field.text()?.to_owned(), MOST_NUMBERS)?,
            (20, field) => kind = field.whole()?,
            _ => {}
        }
    }
    let value = match kind {
        1 => Attribute::Float(float),
        2 => Attribute::Whole(whole),
        3 => Attribute::Text(text),
        4 => Attribute::Tensor(numbers.ok_or_else(|| format!("its setting `{name}` has no tensor"))?),
        6 => Attribute::Floats(floats),
        7 => Attribute::Wholes(wholes),
        8 => Attribute::Texts(texts),
        other => return Err(format!("its setting `{name}` has the type {other}, which is not read")),
    };
    Ok((name, value))
}
