//! The published v7 layout: a folder per frame with `rgb.png`, `depth.npy` and `instance.png`.

use crate::LoadedFlight;
use crate::foreign::{Foreign, Pictures, damaged, identity, sound};
use crate::layout::Layout;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_domain::Channel;
use cosfly_domain::channels::Element;
use cosfly_episodes::v7;
use cosfly_images::read::{self, Picture};
use cosfly_read::StoredImage;
use prost::bytes::Bytes;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const LAYOUT: Layout = Layout {
    doc: "v7 (`<Town>/trajectory_<id>/<trace>/trajectory.json`)",
    recognises: |folder| v7::root(folder).is_some(),
    open: |folder| Ok(Box::new(open(&v7::root(folder).unwrap_or_else(|| folder.to_owned()))?)),
};

/// Opens the dataset whose towns are folders of `root`.
///
/// # Errors
/// `dataset-damaged` where a document cannot be read.
fn open(root: &Path) -> Result<Foreign<Frames>> {
    let (episodes, flags) = v7::motions(root)?;
    sound(root, &flags)?;
    let traces: Vec<PathBuf> = episodes.iter().map(|episode| root.join(&episode.id)).collect();
    let flight = |(episode, trace): (&cosfly_episodes::ExaminedEpisode, &PathBuf)| {
        let stated = episode.camera.map(|camera| [camera.width, camera.height]);
        Ok(LoadedFlight {
            id: episode.id.clone(),
            split: episode.split.clone().unwrap_or_default(),
            frames: episode.moments.len(),
            size: stated.map_or_else(|| first_size(trace), Ok)?,
        })
    };
    let flights = episodes.iter().zip(&traces).map(flight).collect::<Result<Vec<_>>>()?;
    let first: Vec<PathBuf> = traces.iter().map(|trace| v7::frame_folder(trace, 0).join("rgb.png")).collect();
    let identity = identity(&flights, &episodes, &first);
    let folder = root.to_owned();
    Ok(Foreign { layout: "v7", folder, flights, episodes, has_poses: true, identity, pictures: Frames { traces } })
}

/// Folders of the traces.
struct Frames {
    traces: Vec<PathBuf>,
}

impl Pictures for Frames {
    fn channels(&self) -> &[&'static str] {
        &["rgb", "depth", "semantic", "instance"]
    }

    fn advice(&self) -> String {
        "v7 holds rgb, depth, semantic and instance".to_owned()
    }

    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage> {
        let folder = v7::frame_folder(&self.traces[flight], frame);
        match channel.element() {
            Element::Colour => Ok(StoredImage::File(read_file(&folder.join("rgb.png"))?.into(), "png".to_owned())),
            Element::Float => {
                let path = folder.join("depth.npy");
                let (depth_m, width) =
                    v7::depth_of_npy(&read_file(&path)?).map_err(|why| damaged(&path, "it holds no depth", why))?;
                let height = depth_m.len() / width.max(1);
                Ok(raw(depth_m.iter().flat_map(|depth| depth.to_le_bytes()).collect(), [width, height], 4))
            }
            _ => {
                // CARLA's instance camera: the label, the low byte of the id, its high byte.
                let path = folder.join("instance.png");
                let picture = read::decoded(&read_file(&path)?, "png");
                let Picture { size, rgb } = picture.map_err(|why| damaged(&path, "it is no picture", why))?;
                let pixels = rgb.as_chunks::<3>().0.iter();
                Ok(match channel.element() {
                    Element::Label => raw(pixels.map(|[label, ..]| *label).collect(), size, 1),
                    _ => raw(pixels.flat_map(|[_, low, high]| [*low, *high]).collect(), size, 2),
                })
            }
        }
    }
}

fn raw(data: Vec<u8>, [width, height]: [usize; 2], pixel_bytes: usize) -> StoredImage {
    StoredImage::Raw { data: Bytes::from(data), width: width as u32, height: height as u32, pixel_bytes }
}

fn first_size(trace: &Path) -> Result<[u32; 2]> {
    let path = v7::frame_folder(trace, 0).join("rgb.png");
    let picture = read::decoded(&read_file(&path)?, "png").map_err(|why| damaged(&path, "it is no picture", why))?;
    Ok(picture.size.map(|side| side as u32))
}

fn read_file(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => damaged(path, "it is missing", error),
        _ => Diagnostic::io(format!("read `{}`", path.display()), &error),
    })
}
