//! The wire of protocol buffers: fields of a message, read in place.

/// Value of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field<'a> {
    /// A whole number of variable length.
    Number(u64),
    /// Four bytes.
    Four([u8; 4]),
    /// Eight bytes.
    Eight([u8; 8]),
    /// A text, a message, numbers one after the other.
    Bytes(&'a [u8]),
}

/// Fields of a message, in their order. An error is the last.
pub struct Fields<'a> {
    rest: &'a [u8],
}

/// The fields of a message.
pub fn fields(bytes: &[u8]) -> Fields<'_> {
    Fields { rest: bytes }
}

const CUT: &str = "a message is cut off";

/// A whole number of variable length at the beginning of `rest`, which moves on.
pub fn number(rest: &mut &[u8]) -> Result<u64, String> {
    let mut number = 0_u64;
    for at in 0..10 {
        let (byte, after) = rest.split_first().ok_or(CUT)?;
        *rest = after;
        number |= u64::from(byte & 0x7f).checked_shl(7 * at).unwrap_or(0);
        if byte & 0x80 == 0 {
            return Ok(number);
        }
    }
    Err("a number has more than ten bytes".to_owned())
}

impl<'a> Fields<'a> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (taken, rest) = self.rest.split_first_chunk().ok_or(CUT)?;
        self.rest = rest;
        Ok(*taken)
    }

    fn field(&mut self) -> Result<(u64, Field<'a>), String> {
        let key = number(&mut self.rest)?;
        let field = match key & 7 {
            0 => Field::Number(number(&mut self.rest)?),
            1 => Field::Eight(self.take()?),
            2 => {
                let length = number(&mut self.rest)?;
                let length = usize::try_from(length).ok().filter(|length| *length <= self.rest.len()).ok_or(CUT)?;
                let (bytes, rest) = self.rest.split_at(length);
                self.rest = rest;
                Field::Bytes(bytes)
            }
            5 => Field::Four(self.take()?),
            _ => return Err("a field has an unknown type".to_owned()),
        };
        Ok((key >> 3, field))
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<(u64, Field<'a>), String>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.rest = &[];
        }
        Some(field)
    }
}

impl<'a> Field<'a> {
    /// Bytes of a text or a message.
    pub fn bytes(self) -> Result<&'a [u8], String> {
        match self {
            Self::Bytes(bytes) => Ok(bytes),
            _ => Err("a number stands where a message or a text is expected".to_owned()),
        }
    }

    /// Text.
    pub fn text(self) -> Result<&'a str, String> {
        str::from_utf8(self.bytes()?).map_err(|_| "a text is not UTF-8".to_owned())
    }

    /// Whole number.
    pub fn whole(self) -> Result<i64, String> {
        match self {
            Self::Number(number) => Ok(number.cast_signed()),
            _ => Err("a whole number is expected".to_owned()),
        }
    }

    /// Number.
    pub fn float(self) -> Result<f32, String> {
        match self {
            Self::Four(bytes) => Ok(f32::from_le_bytes(bytes)),
            _ => Err("a 32-bit float is expected".to_owned()),
        }
    }

    /// Whole numbers, one or several, at most `most` of them in all.
    pub fn wholes(self, into: &mut Vec<i64>, most: usize) -> Result<(), String> {
        match self {
            Self::Bytes(mut rest) => {
                while !rest.is_empty() {
                    push(into, number(&mut rest)?.cast_signed(), most)?;
                }
                Ok(())
            }
            one => push(into, one.whole()?, most),
        }
    }

    /// Floats, one or several, at most `most` of them in all.
    pub fn floats(self, into: &mut Vec<f32>, most: usize) -> Result<(), String> {
        match self {
            Self::Bytes(bytes) => {
                let (floats, rest) = bytes.as_chunks::<4>();
                if !rest.is_empty() {
                    return Err(CUT.to_owned());
                }
                floats.iter().try_for_each(|float| push(into, f32::from_le_bytes(*float), most))
            }
            one => push(into, one.float()?, most),
        }
    }
}

/// Adds to a list that is bounded.
pub fn push<T>(into: &mut Vec<T>, value: T, most: usize) -> Result<(), String> {
    if into.len() >= most {
        return Err(format!("a list has more than {most} entries"));
    }
    into.push(value);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_read_and_what_is_cut_is_told_once() {
        let bytes = [0x08, 0x96, 0x01, 0x12, 0x02, b'h', b'i', 0x1d, 0, 0, 128, 63];
        let read: Vec<_> = fields(&bytes).map(|field| field.expect("a field")).collect();
        assert_eq!(read[0], (1, Field::Number(150)));
        assert_eq!(read[1].1.text(), Ok("hi"));
        assert_eq!(read[2].1.float(), Ok(1.0));
        for end in [1, 2, 4, 5, 6, 8, 10] {
            let last = fields(&bytes[..end]).last().expect("a field");
            assert_eq!(last.expect_err("cut"), CUT, "{end}");
        }
        assert!(fields(&[0x0b, 1, 1]).count() == 1 && fields(&[0xff; 12]).all(|field| field.is_err()));
    }
}
