//! Pictures of somebody among the splats of a file: `splat_picture OUT_DIR FILE [TOWN.xodr] [X Y Z]`, as `photograph` makes them.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_figures::{BodyShape, Walker};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene, SceneSplats};
use cosfly_splats::{SplatUpAxis, SplatsConfig};
use std::fs::File;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let usage = "usage: splat_picture OUT_DIR FILE [TOWN.xodr] [X Y Z]";
    let mut arguments = std::env::args().skip(1).peekable();
    let (out, file) = (arguments.next().ok_or(usage)?, arguments.next().ok_or(usage)?);
    let map = arguments.next_if(|argument| argument.ends_with(".xodr"));
    let numbers = arguments.map(|argument| argument.parse::<f64>()).collect::<Result<Vec<_>, _>>()?;
    let &[x, y, z] = numbers.first_chunk::<3>().unwrap_or(&[-8.0, 13.5, 0.14]);
    std::fs::create_dir_all(&out)?;
    let town = match &map {
        None => small_town::small_town(2, 1),
        Some(path) => {
            cosfly_maps::read_town(&std::fs::read(path)?, &MapConfig::default(), Seed([5; 32]))
                .map_err(|error| format!("{path}: {error}"))?
                .0
        }
    };
    let config = SplatsConfig::new(file.as_str(), SplatUpAxis::Z);
    let cloud = cosfly_splats::read(&std::fs::read(&file)?)?.cloud;
    let splats = SceneSplats::new(cloud, &config, town.origin.offset_m).map_err(|problem| problem.message)?;
    let target = Walker {
        state: TargetState { feet_in_world: DVec3::new(x, y, z), heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    };
    let camera = RenderConfig::default().camera();
    let mut renderer = Renderer::new(camera);
    let mut weather = cosfly_materials::presets::clear_noon();
    weather.sun_azimuth_angle = 215.0;
    let (plain, scanned) =
        (Scene::new(&town, Seed([1; 32])), Scene::new(&town, Seed([1; 32])).with_splats(Some(splats)));
    for (view, from) in [("follow", [-9.0, -5.0, 7.0]), ("low", [7.0, -5.0, 2.5])] {
        let feet = target.state.feet_in_world;
        let pose = Pose::looking_at(feet + DVec3::from_array(from), feet + DVec3::Z);
        for (name, scene) in [("town", &plain), ("splats", &scanned)] {
            let setup = FrameSetup { pose, weather: &weather, target: Some(target), others: &[] };
            let frame = renderer.render(scene, &setup);
            let file = File::create(Path::new(&out).join(format!("{view}-{name}.png")))?;
            let mut encoder = png::Encoder::new(file, camera.width, camera.height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.write_header()?.write_image_data(&frame.images.rgb)?;
        }
    }
    Ok(())
}
