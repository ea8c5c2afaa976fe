//! LeRobot's layout: pictures inside of tables, or as files that tables name.

use super::tasks;
use crate::LoadedFlight;
use crate::foreign::{Foreign, Pictures, damaged, identity, sound};
use crate::layout::Layout;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::Channel;
use cosfly_episodes::lerobot::{self, features::Features};
use cosfly_episodes::{ExaminedEpisode, Flag};
use cosfly_images::float_tiff;
use cosfly_read::columns::{Column, column};
use cosfly_read::{PictureColumn, PictureFile, StoredImage, inner_path};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub(super) const LAYOUT: Layout = Layout {
    doc: "LeRobot (`meta/info.json`)",
    recognises: |folder| !lerobot::roots(folder).is_empty(),
    open: |folder| Ok(Box::new(open(folder, &lerobot::roots(folder))?)),
};

/// Opens the datasets `roots` in `folder` as one.
///
/// # Errors
/// `dataset-damaged` where tables cannot be read.
fn open(folder: &Path, roots: &[PathBuf]) -> Result<Foreign<Tables>> {
    let (mut flights, mut episodes, mut has_poses) = (vec![], vec![], true);
    let mut pictures = Tables { files: vec![], frames: vec![], features: [None, None], videos: vec![] };
    for root in roots {
        let (found, flags, _) = lerobot::motions(root)?;
        sound(root, &flags)?;
        let info = lerobot::info(root).map_err(|why| damaged(&root.join("meta/info.json"), "it is unreadable", why))?;
        let features = Features::of(&info["features"]);
        has_poses &= features.position.is_some();
        let feature = main_picture(&features.pictures);
        let size = feature.as_ref().map_or([0, 0], |name| size_of(&info["features"][name]));
        let own = [feature, features.depth.clone()];
        pictures.append(root, &own)?;
        pictures.videos.extend(features.videos.clone());
        for (known, own) in pictures.features.iter_mut().zip(own) {
            *known = known.take().or(own);
        }
        let mut captions = captions(root)?;
        for (place, mut episode) in found.into_iter().enumerate() {
            episode.captions = captions.get_mut(place).map(std::mem::take).unwrap_or_default();
            if roots.len() > 1 && episodes.iter().any(|it: &ExaminedEpisode| it.id == episode.id) {
                let split = root.file_name().unwrap_or_default().to_string_lossy();
                episode.id = format!("{split}/{}", episode.id);
            }
            flights.push(LoadedFlight {
                id: episode.id.clone(),
                split: episode.split.clone().unwrap_or_default(),
                frames: episode.moments.len(),
                size,
            });
            episodes.push(episode);
        }
    }
    let frames = flights.iter().zip(&pictures.frames).find(|(flight, rows)| flight.frames != rows.len());
    if let Some((flight, rows)) = frames.filter(|_| !pictures.channels().is_empty()) {
        let message = format!("{} frames have {} of pictures", flight.frames, counted(rows.len(), "row"));
        sound(folder, &[Flag::damage("index-mismatch", &flight.id, message)])?;
    }
    let mut tables = vec![];
    for root in roots {
        tables.extend(data_tables(root)?);
    }
    let identity = identity(&flights, &episodes, &tables);
    let (layout, folder) = ("LeRobot", folder.to_owned());
    Ok(Foreign { layout, folder, flights, episodes, has_poses, identity, pictures })
}

/// Language and text of the instructions of each episode, in the order of their numbers.
fn captions(root: &Path) -> Result<Vec<Vec<(String, String)>>> {
    let tasks = tasks::tasks(root)?;
    let mut first: BTreeMap<i64, i64> = BTreeMap::new();
    for path in data_tables(root)?.into_iter().filter(|_| !tasks.is_empty()) {
        let paths = [path];
        if let (Column::Integers(episodes), Column::Integers(numbers)) =
            (column(&paths, "episode_index")?, column(&paths, "task_index")?)
        {
            episodes.into_iter().zip(numbers).for_each(|(episode, task)| {
                first.entry(episode).or_insert(task);
            });
        }
    }
    let caption = |text: &String| (tasks::language(text).to_owned(), text.clone());
    Ok(first.values().map(|task| tasks.get(task).map(caption).into_iter().collect()).collect())
}

/// Tables of frames, in their order.
fn data_tables(root: &Path) -> Result<Vec<PathBuf>> {
    let is_data = |path: &PathBuf| path.strip_prefix(root).is_ok_and(|inside| inside.starts_with("data"));
    Ok(lerobot::tables(root)?.into_iter().filter(is_data).collect())
}

/// The feature with the colour pictures: one called `rgb`, else the first.
fn main_picture(pictures: &[String]) -> Option<String> {
    pictures.iter().find(|name| name.rsplit('.').next() == Some("rgb")).or(pictures.first()).cloned()
}

/// Width and height of the pictures of a feature, whichever the order of its axes.
fn size_of(feature: &Value) -> [u32; 2] {
    let side = |at: usize| feature["shape"][at].as_u64().and_then(|side| u32::try_from(side).ok()).unwrap_or(0);
    if side(0) <= 4 && side(2) > 4 { [side(2), side(1)] } else { [side(1), side(0)] }
}

/// Pictures of all episodes.
struct Tables {
    /// Tables with the folder that names of files begin at: columns of colours and of depth.
    files: Vec<(PathBuf, [Option<PictureColumn>; 2])>,
    /// Table and row of each frame, flight by flight.
    frames: Vec<Vec<(u32, u32)>>,
    /// Features of colours and of depth.
    features: [Option<String>; 2],
    videos: Vec<String>,
}

impl Tables {
    /// Finds the rows of the frames of the dataset in `root`.
    fn append(&mut self, root: &Path, features: &[Option<String>; 2]) -> Result<()> {
        if features.iter().all(Option::is_none) {
            return Ok(());
        }
        let mut episodes: BTreeMap<i64, Vec<(u32, u32)>> = BTreeMap::new();
        for path in data_tables(root)? {
            let file = self.files.len() as u32;
            if let Column::Integers(numbers) = column(std::slice::from_ref(&path), "episode_index")? {
                for (row, number) in (0..).zip(numbers) {
                    episodes.entry(number).or_default().push((file, row));
                }
            }
            let column = |name: &Option<String>| name.as_ref().map(|name| PictureColumn::open(&path, name)).transpose();
            self.files.push((root.to_owned(), [column(&features[0])?, column(&features[1])?]));
        }
        self.frames.extend(episodes.into_values());
        Ok(())
    }
}

impl Pictures for Tables {
    fn channels(&self) -> &[&'static str] {
        match &self.features {
            [Some(_), Some(_)] => &["rgb", "depth"],
            [Some(_), None] => &["rgb"],
            [None, Some(_)] => &["depth"],
            [None, None] => &[],
        }
    }

    fn advice(&self) -> String {
        let [colours, depth] = &self.features;
        let held = [("rgb", colours), ("depth", depth)].map(|(name, feature)| Some((name, feature.as_ref()?)));
        let held: Vec<(&str, &String)> = held.into_iter().flatten().collect();
        match &held[..] {
            [(name, feature)] => {
                format!("this dataset holds {name} (`{feature}`); `channels=(\"{name}\",)` asks for that alone")
            }
            [..] if !held.is_empty() => "this dataset holds rgb and depth".to_owned(),
            [..] if !self.videos.is_empty() => format!(
                "its pictures are videos ({}), which cosfly does not decode; `channels=()` loads all else, and LeRobot \
                 converts videos to pictures",
                self.videos.join(", ")
            ),
            [..] => "this dataset has no pictures; `channels=()` loads all else".to_owned(),
        }
    }

    fn image(&self, flight: usize, channel: &Channel, frame: usize) -> Result<StoredImage> {
        let (file, row) = self.frames[flight][frame];
        let (root, columns) = &self.files[file as usize];
        let is_depth = channel.name == "depth";
        let pictures = columns[usize::from(is_depth)].as_ref().ok_or_else(|| {
            damaged(root, "a split has no such pictures, and another one has", format!("`{}`", channel.name))
        })?;
        let bytes = match pictures.file(row as usize)? {
            PictureFile::Stored(bytes) => bytes,
            PictureFile::Named(name) => named(root, &name)?,
        };
        if is_depth {
            let (depth_m, [width, height]) =
                float_tiff::read(&bytes).map_err(|why| damaged(root, "a picture of depth cannot be read", why))?;
            let data: Vec<u8> = depth_m.into_iter().flat_map(f32::to_le_bytes).collect();
            let (width, height) = (width as u32, height as u32);
            return Ok(StoredImage::Raw { data: data.into(), width, height, pixel_bytes: 4 });
        }
        let format = if bytes.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
        Ok(StoredImage::File(bytes, format.to_owned()))
    }
}

/// A picture file of the dataset.
fn named(root: &Path, name: &str) -> Result<prost::bytes::Bytes> {
    let outside = || {
        let message = format!("the picture `{name}` is outside the dataset");
        Diagnostic::new("dataset-damaged", Fault::Input, message)
    };
    let path = inner_path(root, name).ok_or_else(outside)?;
    let bytes = std::fs::read(&path);
    Ok(bytes.map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?.into())
}
