//! Splats of a scene: the colours of a scan over the geometry of a town, and bodies among them.

use crate::scan_air::ScanAir;
use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose, real};
use cosfly_materials::scan_light::{CameraCurve, CodeCurve, GroundLight};
use cosfly_splats::{Placement, SplatCloud, SplatRenderer, SplatView, SplatsConfig, SplatsProblem};

/// Splats this little before a body do not cover it, metres: ground that was measured a little too high leaves feet free.
pub(crate) const BEFORE_BODIES_M: f32 = 0.05;

/// A cloud of splats that stands in the world of a town.
pub struct SceneSplats {
    cloud: SplatCloud,
    placement: Placement,
    /// Factor of the splats' light.
    exposure: f32,
    is_antialiased: bool,
}

impl SceneSplats {
    /// Takes over a cloud; `world_origin_m` is what the town's reader took off its map's points.
    ///
    /// # Errors
    /// A place that cannot be used.
    pub fn new(cloud: SplatCloud, config: &SplatsConfig, world_origin_m: DVec3) -> Result<Self, SplatsProblem> {
        let placement = config.placement(world_origin_m)?.counted_from(cloud.origin());
        let exposure = real::powf(2.0, config.exposure_ev) as f32;
        Ok(Self { cloud, placement, exposure, is_antialiased: config.antialiased })
    }
}

/// Buffers that put splats into pictures.
#[derive(Default)]
pub(crate) struct Composer {
    renderer: SplatRenderer,
    curve: Option<Box<CodeCurve>>,
    camera: CameraCurve,
    /// Depth of bodies by pixel, metres; infinite elsewhere.
    pub limit_m: Vec<f32>,
    /// Pixels of bodies.
    pub bodies: Vec<usize>,
    /// Share of its light that each pixel has left in the shadow of bodies; empty: all of it.
    pub lit: Vec<f32>,
    /// Distances between splats and geometry along the optical axis in the last picture, metres, of some pixels.
    off_m: Vec<f32>,
    /// Pixels of bodies that lose more than half of their light to splats, and the depth at which they do, metres.
    pub hiding: Vec<(usize, f32)>,
    /// Ground as it is drawn, beside that of the scan.
    pub ground: GroundLight,
}

/// Pixels from one to the next at which splats are compared with the geometry.
const BETWEEN_LOOKS: usize = 61;

impl Composer {
    /// Puts the splats before the limits over the colours of a picture, whose geometry has these depths.
    pub fn compose(
        &mut self,
        splats: &SceneSplats,
        (camera, pose): (&Camera, &Pose),
        (is_parallel, (factors, air)): (bool, ([f32; 3], Option<ScanAir>)),
        (rgb, depth_m): (&mut [u8], &[f32]),
    ) {
        let view = SplatView::new(camera, pose, &splats.placement, splats.is_antialiased);
        self.renderer.set_parallel(is_parallel);
        let picture = self.renderer.draw(&splats.cloud, &view, Some(&self.limit_m));
        self.off_m.clear();
        let both = picture.depth_m.iter().zip(depth_m).zip(&self.limit_m).step_by(BETWEEN_LOOKS);
        let both = both.filter(|((own, there), limit)| own.is_finite() && there.is_finite() && limit.is_infinite());
        self.off_m.extend(both.map(|((own, there), _)| (own - there).abs()));
        self.hiding.clear();
        let depths = self.bodies.iter().map(|pixel| (*pixel, picture.depth_m[*pixel].min(self.limit_m[*pixel])));
        let is_hidden = |(pixel, depth_m): &(usize, f32)| picture.depth_m[*pixel].is_finite() && *depth_m > 0.0;
        self.hiding.extend(depths.filter(is_hidden));
        let curve = self.curve.get_or_insert_with(|| Box::new(CodeCurve::default()));
        self.camera.prepare(factors, curve);
        let (camera, is_plain) = (&self.camera, self.camera.is_plain());
        let seen = picture.colour.iter().zip(&picture.transmittance);
        for (pixel, (rgb, (colour, light))) in rgb.as_chunks_mut::<3>().0.iter_mut().zip(seen).enumerate() {
            let factor = splats.exposure * self.lit.get(pixel).copied().unwrap_or(1.0);
            let covered = 1.0 - light;
            if let Some(air) = air.as_ref().filter(|_| covered > 0.0) {
                let own_m = picture.depth_m[pixel];
                let kept = air.kept(pixel, picture.width, if own_m.is_finite() { own_m } else { depth_m[pixel] });
                for (k, (byte, own)) in rgb.iter_mut().zip(colour).enumerate() {
                    let own = factor * factors[k] * curve.decoded(own / covered);
                    let own = covered * curve.encoded(air.seen(own, kept, k));
                    *byte = (255.0 * own + light * f32::from(*byte) + 0.5) as u8;
                }
                continue;
            }
            for (k, (byte, own)) in rgb.iter_mut().zip(colour).enumerate() {
                let own = if factor == 1.0 && is_plain || covered <= 0.0 {
                    *own
                } else if factor == 1.0 {
                    covered * camera.code(k, own / covered)
                } else {
                    covered * curve.encoded(factor * factors[k] * curve.decoded(own / covered))
                };
                *byte = (255.0 * own + light * f32::from(*byte) + 0.5) as u8;
            }
        }
    }
}

impl Composer {
    /// Median distance between splats and geometry in the last picture, metres; none where both are nowhere seen.
    pub fn median_off_m(&self) -> Option<f32> {
        let mut sorted = self.off_m.clone();
        sorted.sort_unstable_by(f32::total_cmp);
        sorted.get(sorted.len() / 2).copied()
    }
}
