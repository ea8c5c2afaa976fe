//! Writes a picture of splats as numbers, for a reference of another hand: `draw_splats FILE OUT WIDTH HEIGHT FOV_DEG ANTIALIASED FROM TO`,
//! where FROM and TO are places of the file (`x,y,z`; its z axis is drawn upright) and ANTIALIASED is `true` or `false`. The file has for each
//! pixel, row by row, red, green and blue times the covered share, the share of the light that comes through, and the depth: 32-bit reals.

use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose};
use cosfly_scans::up_axis::UpAxis;
use cosfly_splats::{SplatRenderer, SplatView, SplatsConfig, read};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out, width, height, fov_deg, is_antialiased, from, to] = &arguments[..] else {
        return Err("draw_splats FILE OUT WIDTH HEIGHT FOV_DEG ANTIALIASED FROM TO".into());
    };
    let cloud = read(&std::fs::read(file)?)?.cloud;
    let place = |text: &str| -> Result<DVec3, Box<dyn std::error::Error>> {
        let numbers = text.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let numbers: [f64; 3] = numbers.try_into().map_err(|_| "a place has three numbers")?;
        // The world's y points south.
        let [x, y, z] = numbers;
        Ok(DVec3::new(x, -y, z))
    };
    let camera = Camera {
        width: width.parse()?,
        height: height.parse()?,
        horizontal_fov_rad: fov_deg.parse::<f64>()?.to_radians(),
    };
    let placement = SplatsConfig::new("", UpAxis::Z).placement(DVec3::ZERO).map_err(|problem| problem.message)?;
    let pose = Pose::looking_at(place(from)?, place(to)?);
    let view = SplatView::new(&camera, &pose, &placement.counted_from(cloud.origin()), is_antialiased.parse()?);
    let mut renderer = SplatRenderer::default();
    let picture = renderer.draw(&cloud, &view, None);
    let pixels = picture.colour.iter().zip(&picture.transmittance).zip(&picture.depth_m);
    let numbers = pixels.flat_map(|(([red, green, blue], light), depth_m)| [red, green, blue, light, depth_m]);
    std::fs::write(out, numbers.flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>())?;
    Ok(())
}
