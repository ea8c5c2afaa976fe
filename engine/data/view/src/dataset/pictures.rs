//! Images of flights from their logs, as browsers show them; a few logs stay open.

use super::opened::Opened;
use crate::inside::inside;
use crate::subject::{ViewedPicture, unknown};
use cosfly_channel_pictures::false_colours::{depth_preview, palette_image, picture_on_request};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::channels::{self, Element};
use cosfly_domain::{Channel, SemanticLabel};
use cosfly_images::rgb;
use cosfly_read::{ImageLog, StoredImage};
use std::sync::{Arc, Mutex, PoisonError};

/// Most logs that stay open.
const MOST_OPEN: usize = 8;
/// Quality of pictures of depth, which are no data.
const QUALITY: u8 = 85;

/// The logs that were opened last, the newest at the end.
#[derive(Default)]
pub struct Logs {
    open: Mutex<Vec<(usize, Arc<FlightLog>)>>,
}

/// The images of a flight.
pub struct FlightLog {
    log: ImageLog,
}

impl Logs {
    /// The log of a flight.
    ///
    /// # Errors
    /// `view-unknown`, `view-outside`, damage of the log.
    pub fn of(&self, opened: &Opened, number: usize) -> Result<Arc<FlightLog>> {
        let flight = opened.at(number)?;
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let known = open.iter().position(|(known, _)| *known == number).map(|at| open.remove(at).1);
        let log = match known {
            Some(log) => log,
            None => {
                let path = inside(opened.dataset.folder(), &flight.mcap_path)?;
                let log = ImageLog::open(&path, flight.times())?;
                opened.dataset.identity().check()?;
                Arc::new(FlightLog { log })
            }
        };
        open.push((number, Arc::clone(&log)));
        if open.len() > MOST_OPEN {
            open.remove(0);
        }
        Ok(log)
    }
}

impl FlightLog {
    /// Names of the channels.
    pub fn channels(&self) -> Vec<&'static str> {
        channels::ALL.iter().map(|it| it.name).filter(|name| self.log.channels().any(|known| known == *name)).collect()
    }

    /// The image of a channel in a frame.
    ///
    /// # Errors
    /// `view-unknown`, damage of the log.
    pub fn picture(&self, frame: usize, channel: &str) -> Result<ViewedPicture> {
        let channel = channels::called(channel).filter(|it| self.log.channels().any(|known| known == it.name));
        let channel = channel.ok_or_else(|| unknown("such channel in the log"))?;
        match self.log.image(channel, frame)? {
            StoredImage::File(bytes, _) => stored_picture(bytes.to_vec()),
            StoredImage::Raw { data, width, height, pixel_bytes } => {
                coloured(channel, &data, [width, height], pixel_bytes)
            }
        }
    }
}

/// A stored file: what it is says its beginning, whatever its format is called.
///
/// # Errors
/// `view-image`.
pub fn stored_picture(bytes: Vec<u8>) -> Result<ViewedPicture> {
    let media_type = match &bytes[..] {
        [0xff, 0xd8, 0xff, ..] => "image/jpeg",
        [0x89, b'P', b'N', b'G', ..] => "image/png",
        _ => {
            let message = "an image of the log is neither JPEG nor PNG";
            return Err(Diagnostic::new("view-image", Fault::Input, message).hint("`cosfly verify` says more"));
        }
    };
    Ok(ViewedPicture { media_type, bytes })
}

/// Pixels that are no colours, in colours.
fn coloured(channel: &Channel, data: &[u8], [width, height]: [u32; 2], pixel_bytes: usize) -> Result<ViewedPicture> {
    let (mut bytes, mut media_type) = (vec![], "image/png");
    match channel.element() {
        Element::Float => {
            let numbers: Vec<f32> = data.as_chunks::<4>().0.iter().map(|it| f32::from_le_bytes(*it)).collect();
            media_type = "image/jpeg";
            rgb::jpeg(&depth_preview(&numbers), width, height, QUALITY, &mut bytes)?;
        }
        Element::Label if data.iter().all(|label| usize::from(*label) < SemanticLabel::ALL.len()) => {
            let palette = SemanticLabel::ALL.iter().flat_map(|label| label.colour()).collect();
            rgb::palette_png(data, width, height, palette, &mut bytes)?;
        }
        Element::Label => rgb::png(&palette_image(data), width, height, &mut bytes)?,
        Element::Id => rgb::png(&ids(data, pixel_bytes), width, height, &mut bytes)?,
        _ => rgb::png(&picture_on_request(channel, data), width, height, &mut bytes)?,
    }
    Ok(ViewedPicture { media_type, bytes })
}

/// Ids in colours that tell neighbours apart; 0 is black, 1 (the target) white.
fn ids(data: &[u8], pixel_bytes: usize) -> Vec<u8> {
    let id = |pixel: &[u8]| pixel.iter().rev().fold(0_u32, |id, byte| id << 8 | u32::from(*byte));
    let colour = |id: u32| match id {
        0 => [0; 3],
        1 => [255; 3],
        _ => {
            let [a, b, c, _] = id.wrapping_mul(0x9e37_79b1).to_be_bytes();
            [a, b, c].map(|part| 40 + part / 4 * 3)
        }
    };
    data.chunks_exact(pixel_bytes.max(1)).flat_map(|pixel| colour(id(pixel))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_what_their_beginnings_say() {
        assert_eq!(stored_picture(vec![0xff, 0xd8, 0xff, 0]).expect("JPEG").media_type, "image/jpeg");
        assert!(stored_picture(b"<svg onload=alert(1)>".to_vec()).is_err() && stored_picture(vec![]).is_err());
    }

    #[test]
    fn ids_of_two_and_four_bytes_have_the_same_colours() {
        assert_eq!(ids(&[1, 0, 7, 0], 2), ids(&[1, 0, 0, 0, 7, 0, 0, 0], 4));
        assert_eq!(ids(&[0, 0, 1, 0], 2), [0, 0, 0, 255, 255, 255]);
    }
}
