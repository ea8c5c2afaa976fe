//! CPU time per 1280 x 720 picture of splats, and wall time by threads: `bench_splats [FILE]`; without a file, an invented street of a million
//! splats.

use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_scans::up_axis::UpAxis;
use cosfly_splats::{MOST_COEFFICIENTS, Splat, SplatCloud, SplatRenderer, SplatView, SplatsConfig, read};
use std::time::Instant;

const COUNT: usize = 1_000_000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let started = Instant::now();
    let cloud = match std::env::args().nth(1) {
        Some(path) => read(&std::fs::read(path)?)?.cloud,
        None => street(),
    };
    println!("{} splats in {:.2} s", cloud.len(), started.elapsed().as_secs_f64());
    let config = SplatsConfig::new("", UpAxis::Z);
    let placement = config.placement(DVec3::ZERO).map_err(|problem| problem.message)?;
    let camera = Camera { width: 1280, height: 720, horizontal_fov_rad: std::f64::consts::FRAC_PI_2 };
    for (name, from, to) in [
        ("follow", [-22.0, 3.0, 12.0], [0.0, 0.0, 1.0]),
        ("high", [-50.0, 20.0, 45.0], [0.0; 3]),
        ("street", [-40.0, 0.0, 2.0], [20.0, 2.0, 2.0]),
    ] {
        let pose = Pose::looking_at(DVec3::from_array(from), DVec3::from_array(to));
        let view = SplatView::new(&camera, &pose, &placement, true);
        let mut renderer = SplatRenderer::default();
        let (mut best_s, mut covered) = (f64::INFINITY, 0.0);
        for _ in 0..7 {
            let start = cpu_s(started);
            let picture = renderer.draw(&cloud, &view, None);
            best_s = best_s.min(cpu_s(started) - start);
            covered = picture.transmittance.iter().map(|light| f64::from(1.0 - light)).sum::<f64>() / 921_600.0;
        }
        println!("{name:8} {:7.1} ms of one core, {:4.1} % covered", 1e3 * best_s, 100.0 * covered);
        threads(&cloud, &view)?;
    }
    Ok(())
}

/// Wall time by number of threads, up to the machine's: on a machine that others use, the least of many tries.
fn threads(cloud: &SplatCloud, view: &SplatView) -> Result<(), rayon::ThreadPoolBuildError> {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let mut alone_s = 0.0;
    for count in [1, 2, 4, 8, 16].into_iter().filter(|count| *count <= most) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
        let mut renderer = SplatRenderer::default();
        renderer.set_parallel(true);
        let mut best_s = f64::INFINITY;
        for _ in 0..25 {
            let start = Instant::now();
            pool.install(|| renderer.draw(cloud, view, None).depth_m.len());
            best_s = best_s.min(start.elapsed().as_secs_f64());
        }
        alone_s = if count == 1 { best_s } else { alone_s };
        println!("         {count:2} threads: {:7.1} ms, {:4.2} times as fast", 1e3 * best_s, alone_s / best_s);
    }
    Ok(())
}

/// CPU time of this thread; wall time where the system does not tell it.
fn cpu_s(started: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    own.map_or_else(|| started.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// Ground and two rows of houses, 120 metres long, with colours of degree 3.
fn street() -> SplatCloud {
    let mut stream = Seed::of_item(1, "bench", "street").stream("splats");
    let mut cloud = SplatCloud::new(3);
    for number in 0..COUNT {
        let along = stream.uniform(-60.0, 60.0);
        let (middle, thin) = match number % 5 {
            0 | 1 => ([along, stream.uniform(-9.0, 9.0), 0.0], 2),
            2 | 3 => ([along, if stream.chance(0.5) { -9.0 } else { 9.0 }, stream.uniform(0.0, 14.0)], 1),
            _ => ([along, stream.uniform(-40.0, 40.0), stream.uniform(0.0, 15.0)], 0),
        };
        let mut spread = [0, 1, 2].map(|_| 0.03 + 0.04 * stream.unit() as f32);
        spread[thin] = 0.005;
        let mut harmonics = [[0.0; 3]; MOST_COEFFICIENTS];
        harmonics.iter_mut().flatten().for_each(|value| *value = stream.uniform(-0.1, 0.1) as f32);
        let turn = [1.0, 0.0, 0.0, 0.0];
        let opacity = stream.uniform(0.3, 1.0) as f32;
        cloud.push(&Splat { middle: middle.map(|value| value as f32), spread, turn, opacity, harmonics });
    }
    cloud
}
