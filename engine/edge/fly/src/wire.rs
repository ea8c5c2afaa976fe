//! Messages of policies: msgpack with numpy arrays as `openpi` writes them.
//!
//! An array is a map with the byte-string keys `__ndarray__` (true), `data` (bytes in C order), `dtype` (numpy's short string, such
//! as `<f4`) and `shape`.

use rmpv::Value;

/// Largest message that is accepted, bytes.
pub const LARGEST_BYTES: usize = 16 << 20;
/// Deepest nesting that is accepted.
const DEEPEST: usize = 32;
/// Largest number of entries of an array of actions.
const MOST_NUMBERS: usize = 1 << 16;

/// A field of a message to a policy.
pub enum Field<'a> {
    /// Text.
    Text(&'a str),
    /// Whole number.
    Count(u64),
    /// Number.
    Number(f64),
    /// Array of 32-bit floats.
    Floats(&'a [f32], &'a [usize]),
    /// Array of 32-bit whole numbers from 0 on.
    Ids(&'a [u32], &'a [usize]),
    /// Array of bytes.
    Bytes(&'a [u8], &'a [usize]),
}

/// Encodes a message.
pub fn encode(fields: &[(&str, Field<'_>)]) -> Vec<u8> {
    let entry = |(name, field): &(&str, Field<'_>)| {
        let value = match field {
            Field::Text(text) => Value::from(*text),
            Field::Count(count) => Value::from(*count),
            Field::Number(number) => Value::F64(*number),
            Field::Floats(values, shape) => {
                array(values.iter().flat_map(|value| value.to_le_bytes()).collect(), "<f4", shape)
            }
            Field::Ids(values, shape) => {
                array(values.iter().flat_map(|value| value.to_le_bytes()).collect(), "<u4", shape)
            }
            Field::Bytes(values, shape) => array(values.to_vec(), "|u1", shape),
        };
        (Value::from(*name), value)
    };
    let mut bytes = Vec::new();
    let map = Value::Map(fields.iter().map(entry).collect());
    rmpv::encode::write_value(&mut bytes, &map).expect("memory takes all bytes");
    bytes
}

fn array(data: Vec<u8>, dtype: &str, shape: &[usize]) -> Value {
    let key = |name: &str| Value::Binary(name.as_bytes().to_vec());
    Value::Map(vec![
        (key("__ndarray__"), Value::Boolean(true)),
        (key("data"), Value::Binary(data)),
        (key("dtype"), Value::from(dtype)),
        (key("shape"), Value::Array(shape.iter().map(|size| Value::from(*size as u64)).collect())),
    ])
}

/// Decodes a message.
///
/// # Errors
/// The reason why the bytes are no message, in words.
pub fn decode(bytes: &[u8]) -> Result<Value, String> {
    let mut rest = bytes;
    let value = rmpv::decode::read_value_with_max_depth(&mut rest, DEEPEST)
        .map_err(|error| format!("the message is not msgpack: {error}"))?;
    if rest.is_empty() { Ok(value) } else { Err(format!("{} bytes follow the message", rest.len())) }
}

/// Entry of a map by its name, as text or as byte string.
pub fn entry<'v>(value: &'v Value, name: &str) -> Option<&'v Value> {
    let is_meant = |key: &Value| key.as_slice().is_some_and(|key| key == name.as_bytes());
    value.as_map()?.iter().find(|(key, _)| is_meant(key)).map(|(_, value)| value)
}

/// Numbers of an array and its shape: a numpy array or scalar of floats or whole numbers, or nested lists of numbers.
///
/// # Errors
/// The reason why there are none, in words.
pub fn numbers(value: &Value) -> Result<(Vec<f64>, Vec<usize>), String> {
    if entry(value, "__ndarray__").is_some() {
        return of_numpy(value);
    }
    if entry(value, "__npgeneric__").is_some() {
        let number = entry(value, "data").and_then(Value::as_f64).ok_or("a numpy scalar without a number")?;
        return Ok((vec![number], vec![]));
    }
    let (mut flat, mut shape) = (Vec::new(), Vec::new());
    of_lists(value, 0, &mut flat, &mut shape)?;
    Ok((flat, shape))
}

fn of_numpy(value: &Value) -> Result<(Vec<f64>, Vec<usize>), String> {
    let dtype = entry(value, "dtype").and_then(text).ok_or("an array without a `dtype`")?;
    let data = entry(value, "data").and_then(Value::as_slice).ok_or("an array without `data`")?;
    let sizes = entry(value, "shape").and_then(Value::as_array).ok_or("an array without a `shape`")?;
    let size = |size: &Value| size.as_u64().and_then(|size| usize::try_from(size).ok());
    let shape: Vec<usize> =
        sizes.iter().map(size).collect::<Option<_>>().ok_or("a `shape` that is no list of sizes")?;
    let count = shape.iter().try_fold(1_usize, |product, size| product.checked_mul(*size));
    let count = count.filter(|count| *count <= MOST_NUMBERS).ok_or_else(|| format!("a shape of {shape:?}"))?;
    macro_rules! read {
        ($type:ty, $from:ident) => {{
            let (chunks, rest) = data.as_chunks::<{ size_of::<$type>() }>();
            if chunks.len() != count || !rest.is_empty() {
                return Err(format!("an array of shape {shape:?} and type `{dtype}` with {} bytes", data.len()));
            }
            chunks.iter().map(|bytes| <$type>::$from(*bytes) as f64).collect()
        }};
    }
    let numbers = match dtype {
        "<f4" => read!(f32, from_le_bytes),
        "<f8" => read!(f64, from_le_bytes),
        ">f4" => read!(f32, from_be_bytes),
        ">f8" => read!(f64, from_be_bytes),
        "<i4" => read!(i32, from_le_bytes),
        "<i8" => read!(i64, from_le_bytes),
        "<u4" => read!(u32, from_le_bytes),
        "|i1" => read!(i8, from_le_bytes),
        "|u1" => read!(u8, from_le_bytes),
        other => return Err(format!("an array of type `{other}`; `<f4`, `<f8` and whole numbers are read")),
    };
    Ok((numbers, shape))
}

fn text(value: &Value) -> Option<&str> {
    value.as_str().or_else(|| std::str::from_utf8(value.as_slice()?).ok())
}

fn of_lists(value: &Value, depth: usize, flat: &mut Vec<f64>, shape: &mut Vec<usize>) -> Result<(), String> {
    if let Some(number) = value.as_f64() {
        flat.push(number);
        let is_deepest = depth == shape.len();
        return if is_deepest { Ok(()) } else { Err("lists of different depths".to_owned()) };
    }
    let list = value.as_array().ok_or_else(|| format!("{} instead of numbers", kind(value)))?;
    match shape.get(depth) {
        Some(size) if *size != list.len() => return Err("lists of different lengths".to_owned()),
        Some(_) => {}
        None if flat.is_empty() => shape.push(list.len()),
        None => return Err("lists of different depths".to_owned()),
    }
    list.iter().try_for_each(|item| of_lists(item, depth + 1, flat, shape))
}

/// Kind of a value, in words.
pub fn kind(value: &Value) -> &'static str {
    match value {
        Value::Nil => "nothing",
        Value::Boolean(_) => "a truth value",
        Value::Integer(_) | Value::F32(_) | Value::F64(_) => "a number",
        Value::String(_) => "a text",
        Value::Binary(_) => "a byte string",
        Value::Array(_) => "a list",
        Value::Map(_) => "a map",
        Value::Ext(..) => "an extension value",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_come_back_as_they_went() {
        let bytes = encode(&[
            ("state", Field::Floats(&[1.5, -2.0, 3.0, 4.0], &[2, 2])),
            ("image", Field::Bytes(&[7, 8], &[1, 2])),
            ("step", Field::Count(3)),
            ("prompt", Field::Text("follow")),
        ]);
        let message = decode(&bytes).unwrap();
        assert_eq!(numbers(entry(&message, "state").unwrap()), Ok((vec![1.5, -2.0, 3.0, 4.0], vec![2, 2])));
        assert_eq!(numbers(entry(&message, "image").unwrap()), Ok((vec![7.0, 8.0], vec![1, 2])));
        assert_eq!(entry(&message, "step").unwrap().as_u64(), Some(3));
        assert!(entry(&message, "absent").is_none());
    }

    #[test]
    fn sizes_that_lie_and_types_of_objects_are_refused() {
        let given = |dtype: &str, shape: &[usize], bytes: usize| numbers(&array(vec![0; bytes], dtype, shape));
        assert!(given("<f4", &[2, 5], 40).is_ok());
        for (dtype, shape, bytes) in [
            ("<f4", &[2, 5][..], 39),
            ("<f4", &[usize::MAX, 2], 8),
            ("<f8", &[1 << 40], 8),
            ("|O", &[1], 8),
            ("<c8", &[1], 8),
            ("<f4", &[0, 5], 20),
        ] {
            assert!(given(dtype, shape, bytes).is_err(), "{dtype} {shape:?}");
        }
        for bytes in [&b""[..], b"\xdd\xff\xff\xff\xff", b"\x93\x01", &[0x91; 500]] {
            assert!(decode(bytes).is_err(), "{bytes:?}");
        }
    }

    #[test]
    fn nested_lists_are_arrays_when_they_are_even() {
        let list = |items: Vec<Value>| Value::Array(items);
        let row = || list(vec![Value::from(1), Value::F64(2.5)]);
        assert_eq!(numbers(&list(vec![row(), row()])), Ok((vec![1.0, 2.5, 1.0, 2.5], vec![2, 2])));
        assert!(numbers(&list(vec![row(), Value::from(1)])).is_err());
        assert!(numbers(&list(vec![row(), list(vec![Value::from(1)])])).is_err());
        assert!(numbers(&Value::from("five")).is_err());
    }
}
