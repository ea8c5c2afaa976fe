//! Writes the example files of the formats of point clouds: `write_clouds` from the repository's root.
//!
//! All show one scene: level ground, a house with a pitched roof, a tree, a post.

use cosfly_frames::real::hypot;
use laz::{LasZipCompressor, LasZipError, LazItemRecordBuilder, LazVlr};
use std::io::Cursor;

/// A point: position in metres, class of the ASPRS standard.
pub type Point = ([f64; 3], u8);

/// Points of the scene, the ground first.
pub fn scene() -> Vec<Point> {
    let mut points = Vec::new();
    for i in 0..40 {
        for j in 0..40 {
            // Uneven, so that no two coordinates repeat for ever.
            let (x, y) = (f64::from(i) + 0.01 * f64::from(j % 7), f64::from(j) + 0.01 * f64::from(i % 5));
            let from_ridge_m = (y - 12.0).abs();
            let is_house = (8.0..=20.0).contains(&x) && from_ridge_m <= 5.0;
            let is_crown = hypot(x - 30.0, y - 30.0) < 3.2;
            match (is_house, is_crown) {
                (true, _) => points.push(([x, y, 8.0 - 0.5 * from_ridge_m], 6)),
                (_, true) => {
                    // Leaves are rough, roofs are not.
                    let rough_m = 0.6 * f64::from((i * i + 3 * j * j + i * j) % 5);
                    points.push(([x, y, 7.0 - 0.4 * hypot(x - 30.0, y - 30.0) - rough_m], 5));
                    points.push(([x, y, 3.0], 5));
                }
                _ => points.push(([x, y, 0.02 * x], 2)),
            }
        }
    }
    points.extend((0..12).map(|i| ([25.2 + 0.01 * f64::from(i), 5.1, 0.5 + 0.3 * f64::from(i)], 1)));
    points
}

/// A LAS 1.4 file of point format 6, its points compressed or plain.
pub fn las(points: &[Point], is_compressed: bool) -> Result<Vec<u8>, LasZipError> {
    const HEAD_BYTES: u16 = 375;
    const RECORD_BYTES: u16 = 30;
    const PROJECTION: &str = r#"PROJCS["test",GEOGCS["g",UNIT["degree",0.0174532925199433]],UNIT["metre",1]]"#;
    let vlr = LazVlr::from_laz_items(LazItemRecordBuilder::default_for_point_format_id(6, 0)?);
    let mut packing = Vec::new();
    vlr.write_to(&mut packing)?;
    let mut records = vec![record("LASF_Projection", 2112, PROJECTION.as_bytes())];
    if is_compressed {
        records.push(record("laszip encoded", 22204, &packing));
    }
    let points_start = HEAD_BYTES as usize + records.iter().map(Vec::len).sum::<usize>();
    let mut head = vec![0; HEAD_BYTES.into()];
    let mut put = |at: usize, bytes: &[u8]| head[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, b"LASF");
    put(6, &16_u16.to_le_bytes());
    put(24, &[1, 4]);
    put(94, &HEAD_BYTES.to_le_bytes());
    put(96, &(points_start as u32).to_le_bytes());
    put(100, &(records.len() as u32).to_le_bytes());
    put(104, &[6 | u8::from(is_compressed) << 7]);
    put(105, &RECORD_BYTES.to_le_bytes());
    for axis in 0..3 {
        put(131 + 8 * axis, &0.01_f64.to_le_bytes());
    }
    put(247, &(points.len() as u64).to_le_bytes());
    let mut stored = Vec::new();
    for (position, class) in points {
        let first = stored.len();
        stored.resize(first + usize::from(RECORD_BYTES), 0);
        for (axis, coordinate) in position.iter().enumerate() {
            stored[first + 4 * axis..][..4].copy_from_slice(&((coordinate * 100.0).round() as i32).to_le_bytes());
        }
        stored[first + 14] = 0x11;
        stored[first + 16] = *class;
    }
    let mut file = [head, records.concat()].concat();
    if !is_compressed {
        file.extend(stored);
        return Ok(file);
    }
    // The place of the table of chunks counts from the beginning of the file.
    let mut target = Cursor::new(file);
    target.set_position(points_start as u64);
    let mut compressor = LasZipCompressor::new(target, vlr)?;
    compressor.compress_many(&stored)?;
    compressor.done()?;
    Ok(compressor.into_inner().into_inner())
}

fn record(user: &str, number: u16, data: &[u8]) -> Vec<u8> {
    let mut out = vec![0; 54];
    out[2..2 + user.len()].copy_from_slice(user.as_bytes());
    out[18..20].copy_from_slice(&number.to_le_bytes());
    out[20..22].copy_from_slice(&(data.len() as u16).to_le_bytes());
    out.extend(data);
    out
}

/// Encodings of PLY files.
pub const PLY_ENCODINGS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

/// A PLY file with a column of classes.
pub fn ply(points: &[Point], encoding: &str) -> Vec<u8> {
    let columns = "property double x\nproperty double y\nproperty double z\nproperty uchar classification\n";
    let head = format!("ply\nformat {encoding} 1.0\nelement vertex {}\n{columns}end_header\n", points.len());
    let mut out = head.into_bytes();
    for ([x, y, z], class) in points {
        match encoding {
            "ascii" => out.extend(format!("{x:.3} {y:.3} {z:.3} {class}\n").bytes()),
            "binary_little_endian" => out.extend([x, y, z].into_iter().flat_map(|number| number.to_le_bytes())),
            _ => out.extend([x, y, z].into_iter().flat_map(|number| number.to_be_bytes())),
        }
        if encoding != "ascii" {
            out.push(*class);
        }
    }
    out
}

/// Encodings of PCD files.
pub const PCD_ENCODINGS: [&str; 3] = ["ascii", "binary", "binary_compressed"];

/// A PCD file without classes.
pub fn pcd(points: &[Point], encoding: &str) -> Vec<u8> {
    let fields = "FIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 1\n";
    let size = format!("WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\n", points.len());
    let mut out = format!("# .PCD v0.7\nVERSION 0.7\n{fields}{size}DATA {encoding}\n").into_bytes();
    let row =
        |position: &[f64; 3]| position.iter().flat_map(|number| (*number as f32).to_le_bytes()).collect::<Vec<u8>>();
    match encoding {
        "ascii" => {
            out.extend(points.iter().flat_map(|([x, y, z], _)| format!("{x:.3} {y:.3} {z:.3} 7\n").into_bytes()))
        }
        "binary" => points.iter().for_each(|(position, _)| out.extend([row(position), vec![7, 0]].concat())),
        _ => {
            let axis = |axis: usize| points.iter().flat_map(move |(position, _)| (position[axis] as f32).to_le_bytes());
            let plain: Vec<u8> = (0..3).flat_map(axis).chain(points.iter().flat_map(|_| [7, 0])).collect();
            let packed = pack(&plain);
            out.extend([packed.len() as u32, plain.len() as u32].into_iter().flat_map(u32::to_le_bytes));
            out.extend(packed);
        }
    }
    out
}

/// Packs bytes as LZF does: copies where the last place of the next three bytes is near, plain runs elsewhere.
fn pack(plain: &[u8]) -> Vec<u8> {
    let (mut out, mut run, mut at) = (Vec::new(), Vec::new(), 0);
    let mut last = std::collections::BTreeMap::new();
    let flush = |run: &mut Vec<u8>, out: &mut Vec<u8>| {
        for part in run.chunks(32) {
            out.push(part.len() as u8 - 1);
            out.extend(part);
        }
        run.clear();
    };
    while at < plain.len() {
        let next = plain.get(at..at + 3).and_then(|key| last.insert(key, at)).filter(|place| at - place <= 1 << 13);
        match next {
            Some(place) => {
                let longest = (plain.len() - at).min(264);
                let length = (0..longest).take_while(|i| plain[place + i] == plain[at + i]).count();
                let (back, count) = (at - place - 1, length - 2);
                flush(&mut run, &mut out);
                let high = (back >> 8) as u8;
                if count < 7 {
                    out.push((count as u8) << 5 | high);
                } else {
                    out.extend([7 << 5 | high, (count - 7) as u8]);
                }
                out.push(back as u8);
                at += length;
            }
            None => {
                run.push(plain[at]);
                at += 1;
            }
        }
    }
    flush(&mut run, &mut out);
    out
}

/// Places of the example files, and their content.
pub fn files() -> Result<Vec<(&'static str, Vec<u8>)>, LasZipError> {
    let points = scene();
    Ok(vec![
        ("src/las/example.laz", las(&points, true)?),
        ("src/cloud/example.pcd", pcd(&points, "binary_compressed")),
        ("src/cloud/example.ply", ply(&points, "binary_little_endian")),
    ])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (path, bytes) in files()? {
        std::fs::write(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path), bytes)?;
    }
    Ok(())
}
