//! Columns of foreign tables, each converted to one type: numbers to f64 or i64, texts to UTF-8, files to bytes.

use arrow_array::builder::{BinaryBuilder, StringBuilder};
use arrow_array::cast::AsArray;
use arrow_array::types::{
    Float16Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{Array, ArrayRef, BinaryArray, Float64Array, Int64Array, StringArray, UInt64Array};
use arrow_schema::DataType;

/// Numbers of any width, and booleans as 0 and 1; `None` for other types.
pub fn reals(array: &ArrayRef) -> Option<Float64Array> {
    macro_rules! widened {
        ($kind:ty) => {
            Some(array.as_primitive::<$kind>().unary::<_, Float64Type>(|value| value as f64))
        };
    }
    match array.data_type() {
        DataType::Float64 => Some(array.as_primitive::<Float64Type>().clone()),
        DataType::Float32 => widened!(Float32Type),
        DataType::Float16 => Some(array.as_primitive::<Float16Type>().unary(f64::from)),
        DataType::Int8 => widened!(Int8Type),
        DataType::Int16 => widened!(Int16Type),
        DataType::Int32 => widened!(Int32Type),
        DataType::Int64 => widened!(Int64Type),
        DataType::UInt8 => widened!(UInt8Type),
        DataType::UInt16 => widened!(UInt16Type),
        DataType::UInt32 => widened!(UInt32Type),
        DataType::UInt64 => widened!(UInt64Type),
        DataType::Boolean => Some(array.as_boolean().iter().map(|it| it.map(|it| f64::from(u8::from(it)))).collect()),
        DataType::Dictionary(..) => reals(&unpacked(array)?),
        _ => None,
    }
}

/// Integers of any width, also those stored as floats; null where a number is not whole. `None` for other types.
pub fn integers(array: &ArrayRef) -> Option<Int64Array> {
    if *array.data_type() == DataType::Int64 {
        return Some(array.as_primitive::<Int64Type>().clone());
    }
    if *array.data_type() == DataType::UInt64 {
        let values = array.as_primitive::<UInt64Type>().iter();
        return Some(values.map(|value| value.and_then(|value| i64::try_from(value).ok())).collect());
    }
    // All integers below 2^53 are exact as f64.
    let whole = |value: f64| (value.fract() == 0.0 && value.abs() < 9e15).then_some(value as i64);
    Some(reals(array)?.iter().map(|value| value.and_then(whole)).collect())
}

/// Texts of any layout; `None` for other types.
pub fn texts(array: &ArrayRef) -> Option<StringArray> {
    fn gathered<'a>(values: impl Iterator<Item = Option<&'a str>>) -> StringArray {
        let mut texts = StringBuilder::new();
        values.for_each(|value| texts.append_option(value));
        texts.finish()
    }
    match array.data_type() {
        DataType::Utf8 => Some(array.as_string::<i32>().clone()),
        DataType::LargeUtf8 => Some(gathered(array.as_string::<i64>().iter())),
        DataType::Utf8View => Some(gathered(array.as_string_view().iter())),
        DataType::Dictionary(..) => texts(&unpacked(array)?),
        _ => None,
    }
}

/// Byte strings of any layout; `None` for other types.
pub fn files(array: &ArrayRef) -> Option<BinaryArray> {
    fn gathered<'a>(values: impl Iterator<Item = Option<&'a [u8]>>) -> BinaryArray {
        let mut files = BinaryBuilder::new();
        values.for_each(|value| files.append_option(value));
        files.finish()
    }
    match array.data_type() {
        DataType::Binary => Some(array.as_binary::<i32>().clone()),
        DataType::LargeBinary => Some(gathered(array.as_binary::<i64>().iter())),
        DataType::BinaryView => Some(gathered(array.as_binary_view().iter())),
        DataType::FixedSizeBinary(_) => Some(gathered(array.as_fixed_size_binary().iter())),
        _ => None,
    }
}

/// Values of a dictionary array, such as a category of pandas, row by row.
fn unpacked(array: &ArrayRef) -> Option<ArrayRef> {
    let dictionary = array.as_any_dictionary_opt()?;
    if dictionary.values().is_empty() {
        return None;
    }
    let nulls = dictionary.keys().logical_nulls();
    let keys = dictionary.normalized_keys().into_iter().map(|key| key as u64).collect::<Vec<_>>();
    arrow_select::take::take(dictionary.values().as_ref(), &UInt64Array::new(keys.into(), nulls), None).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::types::Int32Type as Key;
    use arrow_array::{BooleanArray, DictionaryArray, Float32Array, LargeStringArray, UInt8Array, UInt64Array};
    use std::sync::Arc;

    #[test]
    fn numbers_of_any_width_become_f64_and_i64() {
        let bytes: ArrayRef = Arc::new(UInt8Array::from(vec![Some(7), None]));
        assert_eq!(reals(&bytes), Some(Float64Array::from(vec![Some(7.0), None])));
        assert_eq!(integers(&bytes), Some(Int64Array::from(vec![Some(7), None])));
        let floats: ArrayRef = Arc::new(Float32Array::from(vec![3.0, 2.5, f32::NAN, 1e30]));
        assert_eq!(integers(&floats), Some(Int64Array::from(vec![Some(3), None, None, None])));
        let large: ArrayRef = Arc::new(UInt64Array::from(vec![u64::MAX, (1 << 60) + 1]));
        assert_eq!(integers(&large), Some(Int64Array::from(vec![None, Some((1 << 60) + 1)])));
        let truths: ArrayRef = Arc::new(BooleanArray::from(vec![true, false]));
        assert_eq!(reals(&truths), Some(Float64Array::from(vec![1.0, 0.0])));
    }

    #[test]
    fn texts_of_any_layout_become_utf8_and_numbers_are_no_texts() {
        let large: ArrayRef = Arc::new(LargeStringArray::from(vec![Some("a"), None]));
        assert_eq!(texts(&large), Some(StringArray::from(vec![Some("a"), None])));
        let category: ArrayRef =
            Arc::new([Some("x"), None, Some("y"), Some("x")].into_iter().collect::<DictionaryArray<Key>>());
        assert_eq!(texts(&category), Some(StringArray::from(vec![Some("x"), None, Some("y"), Some("x")])));
        assert_eq!(texts(&(Arc::new(UInt8Array::from(vec![1])) as ArrayRef)), None);
        assert_eq!(reals(&large), None);
    }
}
