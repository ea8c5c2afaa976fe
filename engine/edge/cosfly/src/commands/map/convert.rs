//! `cosfly map convert`: a town as a textured mesh or as Gaussian splats, a scan whose truth is known.

use super::town;
use crate::arguments::file_ending_in;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_bake::{BakeProblem, MOST_TEXELS, bake};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::{Town, Weather};
use cosfly_experts::artifacts;
use cosfly_fingerprint::Digest;
use cosfly_frames::Seed;
use cosfly_splats::MOST_SPLATS;
use std::path::{Path, PathBuf};

/// Write the town of a map file as a textured mesh (.glb) or as Gaussian splats (.ply)
#[derive(Debug, Parser)]
#[command(
    name = "convert",
    after_help = "\
Examples:
  cosfly map convert town.xodr --out town.glb                  a mesh with a picture of every face
  cosfly map convert town.xodr --out town.ply --texel-m 0.1    a splat every 10 cm
  cosfly map convert Town01.xodr --out part.ply --set 'bounds_m=[-60, -60, 60, 60]'

Sun and shadows at noon are in the pictures. The page \"A known scene\" of the book films a town in all three forms."
)]
pub struct Arguments {
    /// The map file, of any format that the stage `map` reads
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// File to write: a mesh by the ending .glb, splats by .ply
    #[arg(long, value_name = "FILE", value_parser = file_ending_in(&["glb", "ply"]))]
    out: PathBuf,
    /// Side of a pixel, and distance between splats, metres, 0.02 to 1
    #[arg(long, value_name = "M", default_value_t = 0.2)]
    texel_m: f64,
    /// Parameter of the stage `map`, such as fill.trees=true (repeatable)
    #[arg(long = "set", value_name = "PARAMETER=VALUE")]
    parameters: Vec<String>,
}

/// Azimuth of the sun, degrees: given in recipes, it puts the shadows of people beside those of houses.
const SUN_AZIMUTH_DEG: f64 = 140.0;

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let is_mesh = self.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb"));
        if !(0.02..=1.0).contains(&self.texel_m) {
            let message = format!("`--texel-m` is `{}`", self.texel_m);
            return Err(refused(message, "0.02 to 1 metres: half a metre shows shapes, 0.05 window frames").into());
        }
        let map = town::read("map convert", &self.file, &self.parameters)?;
        let (bytes, key) = if is_mesh { self.mesh(&map.town)? } else { self.splats(&map.town)? };
        cosfly_whole::write_file(&self.out, &bytes)
            .map_err(|error| Diagnostic::io(format!("write `{}`", self.out.display()), &error))?;
        console.print(&format!(
            "in a stage `render` over the same map, with `weathers = [\"{WEATHER}\"]` and\n\
             `weather = {{ sun_azimuth_angle = [{SUN_AZIMUTH_DEG}, {SUN_AZIMUTH_DEG}] }}`:\n  {key}\n"
        ))?;
        Ok(exit::SUCCESS)
    }
}

/// Weather of the pictures.
const WEATHER: &str = "ClearNoon";

fn weather() -> Weather {
    Weather { sun_azimuth_angle: SUN_AZIMUTH_DEG, ..cosfly_materials::presets::clear_noon() }
}

impl Arguments {
    fn mesh(&self, town: &Town) -> Result<(Vec<u8>, String), Box<Diagnostic>> {
        let baked = self.baked(town)?;
        let bytes = baked.to_glb(&name(&self.file)).map_err(|error| {
            Diagnostic::new("map-convert", Fault::Machine, format!("the pictures cannot be encoded: {error}"))
        })?;
        Ok((bytes, format!("mesh = {{ source = {:?} }}", name(&self.out))))
    }

    fn splats(&self, town: &Town) -> Result<(Vec<u8>, String), Box<Diagnostic>> {
        let splats = self.baked(town)?.splats();
        if splats.len() > MOST_SPLATS {
            return Err(self.too_large(splats.len(), "splats", MOST_SPLATS));
        }
        Ok((
            cosfly_splats::to_ply(&splats, &name(&self.file)),
            format!("splats = {{ source = {:?}, up_axis = \"z\" }}", name(&self.out)),
        ))
    }

    fn baked(&self, town: &Town) -> Result<cosfly_bake::BakedTown, Box<Diagnostic>> {
        // As in films of the town.
        let looks = Seed(Digest::of(&artifacts::TOWN.encode(town)?).0);
        bake(town, looks, &weather(), self.texel_m)
            .map_err(|BakeProblem { texels }| self.too_large(texels, "pixels", MOST_TEXELS))
    }

    fn too_large(&self, count: usize, what: &str, most: usize) -> Box<Diagnostic> {
        let message = format!("the town needs {count} {what} of {} m; at most {most} are written", self.texel_m);
        refused(message, "give a larger `--texel-m`, or a part of the town: `--set 'bounds_m=[-60, -60, 60, 60]'`")
    }
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

fn refused(message: String, hint: &str) -> Box<Diagnostic> {
    Diagnostic::new("map-convert", Fault::Recipe, message).hint(hint)
}
