//! JPEG files decoded at a fraction of their size: blocks of 8 x 8 coefficients become blocks of 1, 2, 4 or 8 pixels a
//! side, so that small pictures cost little more than the entropy decoding.
//!
//! Read are files of one interleaved Huffman scan in YCbCr, with all channels of equal size or colours of half the
//! size. Everything else is left to a general decoder. Integers only: the same pixels on every processor.

use super::bits::{Bits, Table};
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;

/// Natural place (row * 8 + column) of the coefficients in the order of the file.
const ORDER: [u8; 64] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7, 14, 21,
    28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54,
    47, 55, 62, 63,
];
/// Largest number of pixels of a picture.
const MOST_PIXELS: usize = 1 << 28;

/// A picture in colours.
pub struct DecodedJpeg {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Row-major sRGB pixels.
    pub rgb: Vec<u8>,
}

/// One of the three channels: luma and two colours.
struct Channel {
    /// Blocks per unit of the scan, across and down.
    blocks: [usize; 2],
    quantities: [u16; 64],
    tables: [usize; 2],
    /// Pixels of a block's side in the result.
    side: usize,
    stride: usize,
    pixels: Vec<u8>,
    previous_dc: i32,
}

/// Headers of a file.
#[derive(Default)]
struct Header {
    size: [usize; 2],
    /// Id, blocks, quantisation table of each channel.
    channels: Vec<(u8, [usize; 2], usize)>,
    quantities: [Option<[u16; 64]>; 4],
    dc: [Option<Table>; 4],
    ac: [Option<Table>; 4],
    restart_interval: usize,
}

/// Decodes a file at the smallest fraction (1/8, 1/4, 1/2, 1) that has at least `least` pixels across and down; `None` for
/// files of other kinds and for damaged ones.
pub fn decode(file: &[u8], least: [usize; 2]) -> Option<DecodedJpeg> {
    let (header, selected, start) = read_header(file)?;
    let [width, height] = header.size;
    let scaled = |side: usize| [(width * side).div_ceil(8), (height * side).div_ceil(8)];
    let side = [1, 2, 4, 8].into_iter().find(|side| (0..2).all(|axis| scaled(*side)[axis] >= least[axis])).unwrap_or(8);
    let most = [0, 1].map(|axis| header.channels.iter().map(|channel| channel.1[axis]).max().unwrap_or(1));
    let units = [width.div_ceil(8 * most[0]), height.div_ceil(8 * most[1])];
    let mut channels = vec![];
    for ((_, blocks, quantities), tables) in header.channels.iter().zip(selected) {
        let share = [most[0] / blocks[0], most[1] / blocks[1]];
        // Colours of half the size are decoded twice as large.
        let own = match share {
            [1, 1] => side,
            [2, 2] if side < 8 => 2 * side,
            _ => return None,
        };
        let (across, down) = (units[0] * blocks[0] * own, units[1] * blocks[1] * own);
        channels.push(Channel {
            blocks: *blocks,
            quantities: header.quantities[*quantities]?,
            tables,
            side: own,
            stride: across,
            pixels: vec![0; across * down],
            previous_dc: 0,
        });
    }
    read_scan(Level::best(), &file[start..], &header, &mut channels, units)?;
    Some(DecodedJpeg { size: scaled(side), rgb: colours(Level::best(), &channels, scaled(side)) })
}

/// Headers, the Huffman tables of each channel, and the start of the scan.
fn read_header(file: &[u8]) -> Option<(Header, Vec<[usize; 2]>, usize)> {
    let mut header = Header::default();
    let mut at = 2;
    file.starts_with(b"\xff\xd8").then_some(())?;
    loop {
        let marker = *file.get(at + 1).filter(|_| file.get(at) == Some(&0xff))?;
        if marker == 0xff {
            at += 1;
            continue;
        }
        let length = usize::from(u16::from_be_bytes(*file.get(at + 2..)?.first_chunk()?));
        let body = file.get(at + 4..(at + 2).checked_add(length)?)?;
        at += 2 + length;
        match marker {
            0xc0 | 0xc1 => read_frame(body, &mut header)?,
            0xc4 => read_tables(body, &mut header)?,
            0xdb => read_quantities(body, &mut header)?,
            0xdd => header.restart_interval = usize::from(u16::from_be_bytes(*body.first_chunk()?)),
            // Colours are not YCbCr when Adobe's marker says so.
            0xee if body.starts_with(b"Adobe") && body.get(11) != Some(&1) => return None,
            0xe0..=0xef | 0xfe => {}
            0xda => {
                let count = usize::from(*body.first()?);
                (count == 3 && header.channels.len() == 3 && body.len() == 1 + 2 * count + 3).then_some(())?;
                let mut selected = vec![];
                for ((id, ..), chosen) in header.channels.iter().zip(body[1..].chunks_exact(2)) {
                    (chosen[0] == *id).then_some(())?;
                    let tables = [usize::from(chosen[1] >> 4), usize::from(chosen[1] & 15)];
                    tables.iter().all(|table| *table < 4).then_some(())?;
                    selected.push(tables);
                }
                (body[1 + 2 * count..] == [0, 63, 0]).then_some(())?;
                return Some((header, selected, at));
            }
            _ => return None,
        }
    }
}

fn read_frame(body: &[u8], header: &mut Header) -> Option<()> {
    let [8, h1, h0, w1, w0, 3, channels @ ..] = body else { return None };
    header.size = [[*w1, *w0], [*h1, *h0]].map(|side| usize::from(u16::from_be_bytes(side)));
    let pixels = header.size[0].checked_mul(header.size[1])?;
    ((1..=MOST_PIXELS).contains(&pixels) && channels.len() == 9 && header.channels.is_empty()).then_some(())?;
    for channel in channels.as_chunks::<3>().0 {
        let blocks = [usize::from(channel[1] >> 4), usize::from(channel[1] & 15)];
        (blocks.iter().all(|count| (1..=2).contains(count)) && channel[2] < 4).then_some(())?;
        header.channels.push((channel[0], blocks, usize::from(channel[2])));
    }
    // Ids that spell RGB mean colours as they are.
    let ids: Vec<u8> = header.channels.iter().map(|channel| channel.0).collect();
    (ids != b"RGB" && header.channels[1].1 == header.channels[2].1).then_some(())
}

fn read_tables(mut body: &[u8], header: &mut Header) -> Option<()> {
    while let [kind, rest @ ..] = body {
        let counts = rest.first_chunk::<16>()?;
        let symbols = counts.iter().map(|count| usize::from(*count)).sum::<usize>();
        let table = Table::new(counts, rest.get(16..16 + symbols)?)?;
        let place = usize::from(kind & 15);
        let tables = if kind >> 4 == 0 { &mut header.dc } else { &mut header.ac };
        *tables.get_mut(place).filter(|_| kind >> 4 < 2)? = Some(table);
        body = &rest[16 + symbols..];
    }
    Some(())
}

fn read_quantities(mut body: &[u8], header: &mut Header) -> Option<()> {
    while let [kind, rest @ ..] = body {
        let mut quantities = [0; 64];
        let wide = kind >> 4 == 1;
        let values = rest.get(..if wide { 128 } else { 64 })?;
        for (place, quantity) in quantities.iter_mut().enumerate() {
            let value = |at: usize| u16::from(values[at]);
            *quantity = if wide { value(2 * place) << 8 | value(2 * place + 1) } else { value(place) };
        }
        *header.quantities.get_mut(usize::from(kind & 15)).filter(|_| kind >> 4 < 2)? = Some(quantities);
        body = &rest[values.len()..];
    }
    Some(())
}

simd_kernel! {
    /// Decodes the scan into the channels' pixels.
    fn read_scan(scan: &[u8], header: &Header, channels: &mut [Channel], units: [usize; 2]) -> Option<()> {
        // Places of the coefficients within a block, 64 for those that a small block does not have.
        let places = |side: usize| {
            ORDER.map(|natural| if natural & 7 < side as u8 && natural >> 3 < side as u8 { natural } else { 64 })
        };
        let places: Vec<[u8; 64]> = channels.iter().map(|channel| places(channel.side)).collect();
        let mut bits = Bits::new(scan);
        let mut coefficients = [0i32; 65];
        for unit in 0..units[0] * units[1] {
            if header.restart_interval > 0 && unit > 0 && unit % header.restart_interval == 0 {
                bits.restart()?;
                channels.iter_mut().for_each(|channel| channel.previous_dc = 0);
            }
            for (channel, places) in channels.iter_mut().zip(&places) {
                let (dc, ac) = (header.dc[channel.tables[0]].as_ref()?, header.ac[channel.tables[1]].as_ref()?);
                for block in 0..channel.blocks[0] * channel.blocks[1] {
                    let column = unit % units[0] * channel.blocks[0] + block % channel.blocks[0];
                    let row = unit / units[0] * channel.blocks[1] + block / channel.blocks[0];
                    channel.previous_dc = channel.previous_dc.wrapping_add(bits.dc(dc)?);
                    coefficients[0] = channel.previous_dc.wrapping_mul(i32::from(channel.quantities[0]));
                    let has_more = bits.ac(ac, &channel.quantities, places, &mut coefficients)?;
                    let at = (row * channel.stride + column) * channel.side;
                    let pixels = channel.pixels.get_mut(at..)?;
                    super::inverse::block(channel.side, &coefficients, has_more, pixels, channel.stride);
                    if has_more {
                        coefficients.fill(0);
                    }
                }
            }
        }
        bits.is_sound().then_some(())
    }
}

simd_kernel! {
    /// Pixels of equally large channels, converted from YCbCr (JFIF).
    fn colours(channels: &[Channel], size: [usize; 2]) -> Vec<u8> {
        let [width, height] = size;
        let mut rgb = vec![0; 3 * width * height];
        for (row, pixels) in rgb.chunks_exact_mut(3 * width).enumerate() {
            let line = |channel: usize| &channels[channel].pixels[row * channels[channel].stride..][..width];
            let (luma, blue, red) = (line(0), line(1), line(2));
            for (((pixel, y), b), r) in pixels.as_chunks_mut::<3>().0.iter_mut().zip(luma).zip(blue).zip(red) {
                // 1.402, 0.344136, 0.714136 and 1.772 in 16 bits, and a half for rounding.
                let (y, b, r) = ((i32::from(*y) << 16) + 32_768, i32::from(*b) - 128, i32::from(*r) - 128);
                let whole = |value: i32| (value >> 16).clamp(0, 255) as u8;
                *pixel = [whole(y + 91_881 * r), whole(y - 22_554 * b - 46_802 * r), whole(y + 116_130 * b)];
            }
        }
        rgb
    }
}
