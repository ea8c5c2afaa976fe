//! Arrays as files of numpy (`.npy`, version 1.0).

/// A matrix of 32-bit floats with rows of `width` numbers, as a file.
pub fn floats(rows: impl Iterator<Item = f32>, width: usize) -> Vec<u8> {
    let data: Vec<u8> = rows.flat_map(f32::to_le_bytes).collect();
    let count = data.len() / 4 / width.max(1);
    [head("<f4", &format!("({count}, {width})")), data].concat()
}

/// A list of truth values, as a file.
pub fn flags(values: impl Iterator<Item = bool>) -> Vec<u8> {
    let data: Vec<u8> = values.map(u8::from).collect();
    [head("|b1", &format!("({},)", data.len())), data].concat()
}

/// Beginning of a file, up to its numbers.
pub fn head(dtype: &str, shape: &str) -> Vec<u8> {
    let mut head = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, version and length are 10 bytes; the data begin at a multiple of 64.
    let length = (10 + head.len() + 1).next_multiple_of(64) - 10;
    head.extend(std::iter::repeat_n(' ', length - 1 - head.len()));
    head.push('\n');
    [b"\x93NUMPY\x01\x00", &(length as u16).to_le_bytes()[..], head.as_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_aligned_and_name_the_shape() {
        let file = floats([1.0, 2.0, 3.0, 4.0].into_iter(), 2);
        assert!(file.starts_with(b"\x93NUMPY\x01\x00") && file.len() == 128 + 16);
        let head = String::from_utf8_lossy(&file[10..128]);
        assert!(head.contains("'shape': (2, 2)") && head.ends_with('\n'), "{head}");
        assert_eq!(flags([true, false].into_iter())[128..], [1, 0]);
    }
}
