//! `cosfly verify --mesh`, `cosfly doctor --mesh`: the scan that flights are held against.

use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_experts::render_files::read_mesh;
use cosfly_frames::DVec3;
use cosfly_metrics::scanned_mesh::ScannedMesh;
use cosfly_models::mesh::{MeshConfig, MeshTriangle};
use cosfly_read::PublishedDataset;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The scan and its place.
#[derive(Debug, Args)]
pub struct MeshArguments {
    /// Mesh of the scan that was flown in (.glb, .gltf, .obj): flights keep the clearance that they state from its triangles
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Key of `mesh` as in the recipe, such as up_axis=z or origin_m=[0, 0, 2] (repeatable)
    #[arg(long, value_name = "KEY=VALUE", requires = "mesh")]
    mesh_set: Vec<String>,
    /// Town that the mesh is of, where the dataset has several
    #[arg(long, value_name = "TOWN", requires = "mesh")]
    mesh_town: Option<String>,
}

fn refused(message: String, hint: String) -> Box<Diagnostic> {
    Diagnostic::new("mesh-placed", Fault::Recipe, message).hint(hint)
}

impl MeshArguments {
    /// The mesh in the world of the dataset's flights.
    ///
    /// # Errors
    /// Files that cannot be read, keys that no mesh has, a town that is not told.
    pub fn read(&self, dataset: &Path) -> Result<Option<ScannedMesh>> {
        let Some(file) = &self.mesh else { return Ok(None) };
        let mut keys = serde_json::Map::from_iter([("source".to_owned(), "".into())]);
        for change in &self.mesh_set {
            let Some((key, value)) = change.split_once('=') else {
                let hint = "`up_axis=z`, `origin_m=[0, 0, 2]`".into();
                return Err(refused(format!("`--mesh-set {change}` is no key with a value"), hint));
            };
            let value = serde_json::from_str(value).unwrap_or_else(|_| Value::from(value.trim()));
            keys.insert(key.trim().to_owned(), value);
        }
        let mut config: MeshConfig = serde_json::from_value(keys.into()).map_err(|error| {
            let hint =
                "keys are those of `mesh` in stage `render`: `up_axis`, `unit_m`, `turn_deg`, `origin_m`, `files`"
                    .into();
            refused(format!("the mesh cannot be placed: {error}"), hint)
        })?;
        let (town, offset_m) = self.town_of(dataset)?;
        if config.files.is_empty() {
            // Colours count for nothing here: pictures that are not found are told by the mesh.
            let bytes = std::fs::read(file).unwrap_or_default();
            config.files = crate::commands::map::mesh::beside(file, &bytes).into_iter().map(|(name, _)| name).collect();
        }
        let beside: Vec<PathBuf> = config.files.iter().map(|name| file.with_file_name(name)).collect();
        let mesh = read_mesh(&config, file, &beside, offset_m)?;
        Ok(Some(ScannedMesh::new(town, mesh.triangles.iter().map(MeshTriangle::corners))))
    }

    /// The town whose world the mesh lies in, and what its reader took off the map's points; none of data of others.
    fn town_of(&self, dataset: &Path) -> Result<(String, DVec3)> {
        if !dataset.join("data/trajectories").is_dir() {
            return Ok((self.mesh_town.clone().unwrap_or_default(), DVec3::ZERO));
        }
        let dataset = PublishedDataset::open(dataset)?;
        let flights = dataset.flights();
        let mut towns: Vec<&str> = flights.iter().map(|flight| flight.town.as_str()).collect();
        towns.sort_unstable();
        towns.dedup();
        let town = match (&self.mesh_town, &towns[..]) {
            (Some(town), _) if towns.contains(&town.as_str()) => town.as_str(),
            (None, [town]) => town,
            (given, _) => {
                let message = given.as_ref().map_or_else(
                    || "the dataset has flights in several towns".to_owned(),
                    |town| format!("no flight is in a town `{town}`"),
                );
                return Err(refused(message, format!("give one with `--mesh-town`: {}", towns.join(", "))));
            }
        };
        let of_town = flights.iter().find(|flight| flight.town == town);
        Ok((town.to_owned(), of_town.map_or_else(Default::default, |it| it.town_offset_m)))
    }
}
