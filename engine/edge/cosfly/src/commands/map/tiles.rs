//! `cosfly map tiles`: a folder of 3D Tiles as one mesh at one level of detail.

use crate::arguments::file_ending_in;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::count;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_scans::tiles::{JoinedTiles, TilesChoice, join};
use cosfly_town::MapError;
use std::path::{Path, PathBuf};

/// Join a folder of 3D Tiles to one mesh (.glb) that maps and pictures are made of
#[derive(Debug, Parser)]
#[command(
    name = "tiles",
    after_help = "\
Examples:
  cosfly map tiles city/tileset.json --out city.glb                              the finest level of all tiles
  cosfly map tiles city/tileset.json --out square.glb --area-m=-150,-150,150,150 tiles within 150 m of the middle
  cosfly map tiles city/tileset.json --out city.glb --error-m 0.5                a level true to half a metre
  cosfly map tiles city/tileset.json --out city.glb --near-m 15                  true to a pixel from 15 m away
  cosfly map tiles city/tileset.json --out city.glb --origin 48.2082,16.3738,171 counted from a place on the Earth

Opens files of the folder alone; nothing is fetched. The page \"3D Tiles as a scan\" of the book goes on from there."
)]
pub struct Arguments {
    /// The file `tileset.json` of the folder
    #[arg(value_name = "TILESET")]
    file: PathBuf,
    /// File to write, ending in .glb
    #[arg(long, value_name = "GLB", value_parser = file_ending_in(&["glb"]))]
    out: PathBuf,
    /// Largest geometric error of a tile that is not refined, metres, 0 to 1000: a pixel N m away covers N / focal length in pixels
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    error_m: f64,
    /// Nearest place of the camera, metres, in the place of `--error-m`: the level true to a pixel of 1280 x 720 and 90 degrees there
    #[arg(long, value_name = "M", conflicts_with = "error_m")]
    near_m: Option<f64>,
    /// Area that tiles must meet: metres to the west, south, east and north of the origin, negative to the west and south
    #[arg(long, value_name = "W,S,E,N", value_delimiter = ',', allow_negative_numbers = true)]
    area_m: Option<Vec<f64>>,
    /// Origin of the mesh: latitude and longitude in degrees, height above the ellipsoid in metres [default: the tileset's middle]
    #[arg(long, value_name = "LAT,LON,H", value_delimiter = ',', allow_negative_numbers = true)]
    origin: Option<Vec<f64>>,
}

/// Farthest side of an area from the origin, and highest origin, metres.
const FARTHEST_M: f64 = 1e5;
const HIGHEST_M: f64 = 1e4;
/// Focal length of a camera of 1280 pixels and 90 degrees, pixels.
const FOCAL_PX: f64 = 640.0;
/// Longest file of a tile.
const MOST_BYTES: u64 = 4 << 30;

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let choice = self.choice()?;
        let folder = match self.file.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let shown = self.file.display();
        let name = self.file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let root =
            folder.canonicalize().map_err(|error| Diagnostic::unread(format!("the folder of `{shown}`"), &error))?;
        let (stop, mut stopped) = (console.stop(), None);
        let joined = join(&name, &choice, &mut |path| {
            if let Err(end) = stop.check("map tiles") {
                stopped = Some(end);
                return Err(MapError::new("stopped"));
            }
            opened(&root, path)
        });
        if let Some(end) = stopped {
            return Err(end.into());
        }
        let joined = joined.map_err(|error| {
            let refused = Diagnostic::new("map-tiles", Fault::Input, error.message).because(format!("in `{shown}`"));
            error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
        })?;
        cosfly_whole::write_file(&self.out, &joined.glb)
            .map_err(|error| Diagnostic::io(format!("write `{}`", self.out.display()), &error))?;
        console.print(&self.told(&joined))?;
        Ok(exit::SUCCESS)
    }
}

impl Arguments {
    fn choice(&self) -> Result<TilesChoice> {
        let refused = |message: String, hint: &str| Diagnostic::new("map-tiles", Fault::Recipe, message).hint(hint);
        let geometric_error_m = self.near_m.map_or(self.error_m, |near_m| near_m / FOCAL_PX);
        if !(0.0..=1000.0).contains(&geometric_error_m) {
            let message = match self.near_m {
                Some(near_m) => format!("`--near-m` is `{near_m}`"),
                None => format!("`--error-m` is `{}`", self.error_m),
            };
            return Err(refused(message, "0 to 1000 metres of error; 0 is the finest level"));
        }
        let area_m = self.area_m.as_deref().map(<[f64; 4]>::try_from).transpose().ok().filter(|area| {
            area.is_none_or(|[west, south, east, north]| {
                west < east && south < north && [west, south, east, north].iter().all(|it| it.abs() <= FARTHEST_M)
            })
        });
        let Some(area_m) = area_m else {
            let hint = "four numbers: west, south, east, north within 100 km, such as `--area-m=-150,-150,150,150`";
            return Err(refused(format!("`--area-m` is `{:?}`", self.area_m.as_deref().unwrap_or_default()), hint));
        };
        let origin = self.origin.as_deref().map(<[f64; 3]>::try_from).transpose().ok().filter(|origin| {
            origin.is_none_or(|[lat, lon, height_m]| {
                lat.abs() <= 90.0 && lon.abs() <= 180.0 && height_m.abs() <= HIGHEST_M
            })
        });
        let Some(origin) = origin else {
            let hint = "three numbers: latitude -90 to 90, longitude -180 to 180 degrees, height -10,000 to 10,000 m";
            return Err(refused(format!("`--origin` is `{:?}`", self.origin.as_deref().unwrap_or_default()), hint));
        };
        Ok(TilesChoice { geometric_error_m, area_m, origin })
    }

    fn told(&self, joined: &JoinedTiles) -> String {
        let JoinedTiles { origin, tiles, tilesets, geometric_error_m, points, has_own_errors, glb } = joined;
        let name = self.out.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let mut text = format!(
            "{} of {}, true to {geometric_error_m} m by their own statement: {}\n",
            count(*tiles as u64, "tile"),
            count(*tilesets as u64, "tileset"),
            counted(glb.len(), "byte")
        );
        if *points > 0 {
            text += &format!("left out, as without triangles: {}\n", count(*points as u64, "part"));
        }
        if *has_own_errors {
            text += "tiles state geometric errors as properties, which are not read: each level counts as half as coarse as the one above\n";
        }
        text += &match origin {
            Some([lat, lon, height]) => format!(
                "origin: latitude {lat:.7}, longitude {lon:.7} degrees, {height:.2} m above the ellipsoid; x to the east, z to the south\n"
            ),
            None => "origin: that of the tileset, which does not say where on the Earth it is\n".to_owned(),
        };
        text + &format!(
            "in a recipe, in stage `map`: source = {name:?}, and where it is one surface `options = {{ one_surface = true }}`;\n\
             in stage `render`: mesh = {{ source = {name:?} }}\n"
        )
    }
}

/// A file of the tileset's folder, and of no other.
fn opened(root: &Path, path: &str) -> Result<Vec<u8>, MapError> {
    let failed = |error: std::io::Error| {
        MapError::new(format!("the file cannot be read: {error}"))
            .hint("fetch all tiles of the tileset into its folder")
    };
    let file = root.join(path).canonicalize().map_err(failed)?;
    if !file.starts_with(root) {
        return Err(MapError::new("the file lies beyond the tileset's folder").hint("put copies in the place of links"));
    }
    let metadata = std::fs::metadata(&file).map_err(failed)?;
    if !metadata.is_file() || metadata.len() > MOST_BYTES {
        return Err(MapError::new(format!("it is no file of at most {MOST_BYTES} bytes")).hint("split the tile"));
    }
    std::fs::read(&file).map_err(failed)
}
