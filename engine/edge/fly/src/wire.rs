//! Messages of policies: msgpack with numpy arrays as `openpi` writes them.
//!
//! An array is a map with the byte-string keys `__ndarray__` (true), `data` (bytes in C order), `dtype` (numpy's short string, such
//! as `<f4`) and `shape`.

use cosfly_diagnose::counted;
use rmpv::Value;

/// Largest message that is accepted, bytes.
pub const LARGEST_BYTES: usize = 16 << 20;
/// Deepest nesting that is accepted.
const DEEPEST: usize = 32;
/// Largest number of values in a message: a value takes many times its byte once it is read.
const MOST_VALUES: u64 = 1 << 17;
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
    check_count(bytes).map_err(|what| format!("the message {what}"))?;
    let mut rest = bytes;
    let value = rmpv::decode::read_value_with_max_depth(&mut rest, DEEPEST)
        .map_err(|error| format!("the message is not msgpack: {error}"))?;
    if rest.is_empty() { Ok(value) } else { Err(format!("{} follow the message", counted(rest.len(), "byte"))) }
}

/// The refusal of a message that is too long, in words.
pub fn too_long() -> String {
    format!("the answer is longer than {} MiB", LARGEST_BYTES >> 20)
}

/// Checks without reading a value that a message holds as many as it says, and not too many.
fn check_count(bytes: &[u8]) -> Result<(), String> {
    let (mut rest, mut left, mut seen) = (bytes, 1_u64, 0_u64);
    while left > 0 {
        (left, seen) = (left - 1, seen + 1);
        let (marker, after) = rest.split_first().ok_or("is not msgpack: it is cut off")?;
        // Bytes of the length that follows, bytes of the value itself, values inside.
        let number = |width: usize| {
            let bytes = after.get(..width)?;
            Some(bytes.iter().fold(0_u64, |number, byte| number << 8 | u64::from(*byte)))
        };
        let length = |width: usize| number(width).ok_or("is not msgpack: it is cut off");
        let (head, body, inside) = match *marker {
            0x00..=0x7f | 0xc0..=0xc3 | 0xe0..=0xff => (0, 0, 0),
            0x80..=0x8f => (0, 0, 2 * u64::from(marker & 0x0f)),
            0x90..=0x9f => (0, 0, u64::from(marker & 0x0f)),
            0xa0..=0xbf => (0, u64::from(marker & 0x1f), 0),
            0xc4 | 0xd9 => (1, length(1)?, 0),
            0xc5 | 0xda => (2, length(2)?, 0),
            0xc6 | 0xdb => (4, length(4)?, 0),
            0xc7 => (1, length(1)? + 1, 0),
            0xc8 => (2, length(2)? + 1, 0),
            0xc9 => (4, length(4)? + 1, 0),
            0xca | 0xce | 0xd2 => (0, 4, 0),
            0xcb | 0xcf | 0xd3 => (0, 8, 0),
            0xcc | 0xd0 => (0, 1, 0),
            0xcd | 0xd1 => (0, 2, 0),
            0xd4..=0xd8 => (0, 1 + (1 << (marker - 0xd4)), 0),
            0xdc => (2, 0, length(2)?),
            0xdd => (4, 0, length(4)?),
            0xde => (2, 0, 2 * length(2)?),
            0xdf => (4, 0, 2 * length(4)?),
        };
        left += inside;
        if seen + left > MOST_VALUES {
            return Err(format!("holds more than {MOST_VALUES} values"));
        }
        let skipped = usize::try_from(head + body).ok();
        rest = skipped.and_then(|skipped| after.get(skipped..)).ok_or("is not msgpack: it is cut off")?;
    }
    Ok(())
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
    if sizes.len() > DEEPEST {
        return Err(format!("an array of {} dimensions", sizes.len()));
    }
    let size = |size: &Value| size.as_u64().and_then(|size| usize::try_from(size).ok());
    let shape: Vec<usize> =
        sizes.iter().map(size).collect::<Option<_>>().ok_or("a `shape` that is no list of sizes")?;
    let count = shape.iter().try_fold(1_usize, |product, size| product.checked_mul(*size));
    let count = count.filter(|count| *count <= MOST_NUMBERS).ok_or_else(|| format!("a shape of {shape:?}"))?;
    macro_rules! read {
        ($type:ty, $from:ident) => {{
            let (chunks, rest) = data.as_chunks::<{ size_of::<$type>() }>();
            if chunks.len() != count || !rest.is_empty() {
                return Err(format!(
                    "an array of shape {shape:?} and type `{dtype}` with {}",
                    counted(data.len(), "byte")
                ));
            }
            chunks.iter().map(|bytes| <$type>::$from(*bytes) as f64).collect()
        }};
    }
    // `<` and `>` say the order of the bytes; single bytes have none.
    let is_big = dtype.starts_with('>');
    macro_rules! of_order {
        ($type:ty) => {
            if is_big { read!($type, from_be_bytes) } else { read!($type, from_le_bytes) }
        };
    }
    let numbers: Vec<f64> = match dtype.trim_start_matches(['<', '>', '=', '|']) {
        "f2" => {
            let halves: Vec<f64> = of_order!(u16);
            halves.into_iter().map(|bits| of_half(bits as u16)).collect()
        }
        "f4" => of_order!(f32),
        "f8" => of_order!(f64),
        "i1" => read!(i8, from_le_bytes),
        "i2" => of_order!(i16),
        "i4" => of_order!(i32),
        "i8" => of_order!(i64),
        "u1" => read!(u8, from_le_bytes),
        "u2" => of_order!(u16),
        "u4" => of_order!(u32),
        "u8" => of_order!(u64),
        _ => {
            return Err(format!(
                "an array of type `{}`; floats of 2, 4 and 8 bytes and whole numbers are read, such as `<f4`",
                dtype.chars().take(40).collect::<String>()
            ));
        }
    };
    Ok((numbers, shape))
}

/// The number of a float of two bytes.
fn of_half(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff) / 1024.0);
    let size = match exponent {
        0 => fraction * 2_f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction) * 2_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
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
    if flat.len() > MOST_NUMBERS {
        return Err(format!("more than {MOST_NUMBERS} numbers"));
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
    fn every_type_of_numbers_and_both_orders_of_bytes_are_read_right() {
        let read = |dtype: &str, bytes: &[u8]| numbers(&array(bytes.to_vec(), dtype, &[bytes.len() / size(dtype)]));
        let of = |dtype: &str, bytes: &[u8]| read(dtype, bytes).map(|(numbers, _)| numbers);
        assert_eq!(
            of("<f2", &[0x00, 0x3c, 0x00, 0xc5, 0x01, 0x00, 0xff, 0x7b]),
            Ok(vec![1.0, -5.0, 2_f64.powi(-24), 65504.0])
        );
        assert_eq!(of(">f2", &[0x3c, 0x00, 0x7c, 0x00, 0x35, 0x55]), Ok(vec![1.0, f64::INFINITY, 0.333_251_953_125]));
        assert!(of("<f2", &[0x01, 0x7c]).is_ok_and(|numbers| numbers[0].is_nan()));
        for (dtype, le) in [
            ("f4", &(-2.5_f32).to_le_bytes()[..]),
            ("f8", &(-2.5_f64).to_le_bytes()),
            ("i2", &(-300_i16).to_le_bytes()),
            ("i4", &(-300_i32).to_le_bytes()),
            ("i8", &(-300_i64).to_le_bytes()),
            ("u2", &300_u16.to_le_bytes()),
            ("u4", &300_u32.to_le_bytes()),
            ("u8", &300_u64.to_le_bytes()),
        ] {
            let be: Vec<u8> = le.iter().rev().copied().collect();
            let wanted = if dtype.starts_with('f') {
                -2.5
            } else if dtype.starts_with('i') {
                -300.0
            } else {
                300.0
            };
            assert_eq!(of(&format!("<{dtype}"), le), Ok(vec![wanted]), "{dtype}");
            assert_eq!(of(&format!(">{dtype}"), &be), Ok(vec![wanted]), "{dtype}");
        }
        assert_eq!(of("|i1", &[0xff]), Ok(vec![-1.0]));
        for dtype in ["<f16", "|b1", "<U5", "<M8[ns]", "|V2", "<c16"] {
            assert!(numbers(&array(vec![0; 16], dtype, &[1])).is_err_and(|what| what.contains(dtype)), "{dtype}");
        }
        fn size(dtype: &str) -> usize {
            dtype[2..].parse().expect("a size")
        }
    }

    #[test]
    fn messages_of_too_many_values_are_refused_before_they_take_memory() {
        let many = [&[0xdd, 0x00, 0xff, 0xff, 0xff][..], &vec![0xc0; 0xff_ffff]].concat();
        assert!(decode(&many).is_err_and(|what| what.contains("more than 131072 values")));
        let nested = [&[0xdd, 0x00, 0x01, 0x00, 0x00][..], &[0x91, 0x01].repeat(1 << 16)].concat();
        assert!(decode(&nested).is_err_and(|what| what.contains("values")));
        for bytes in [&[0xc6, 0xff, 0xff, 0xff, 0xff][..], &[0xdf, 0xff, 0xff, 0xff, 0xff], &[0xd9, 5, 1], &[0xcb, 0]] {
            assert!(decode(bytes).is_err(), "{bytes:?}");
        }
        for value in [
            Value::Nil,
            Value::from(70_000),
            Value::from("é".repeat(40)),
            Value::Ext(3, vec![1, 2, 3]),
            Value::F32(1.5),
        ] {
            let mut bytes = Vec::new();
            rmpv::encode::write_value(
                &mut bytes,
                &Value::Array(vec![value.clone(), Value::Map(vec![(value, Value::from(-5))])]),
            )
            .unwrap();
            assert!(decode(&bytes).is_ok(), "{bytes:?}");
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
