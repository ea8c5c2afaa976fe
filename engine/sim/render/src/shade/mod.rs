//! The RGB pass: light, materials and weather for the faces seen, row by row.

pub mod facade;
pub mod grid;
pub mod ground;
pub mod light;
pub mod pattern;
pub mod shadow;
pub mod sky;
pub mod smooth;
pub mod surface;
pub mod things;
pub mod tone;

use crate::figure::{Clothes, FigureTriangle};
use crate::frame::FrameImages;
use crate::passes::ids::for_each_run;
use crate::renderer::{DrawnFace, Eye, FaceSource, FrameSetup};
use crate::scene::{BOX_FACES, Scene, SceneBox};
use crate::visibility::{NO_FACE, Screen, Visibility};
use cosfly_frames::{DVec3, Pose};
use cosfly_maps::{ObstacleKind, SemanticLabel};
use glam::{Vec3A as Vec3, Vec4};
use light::Light;
use pattern::{hash, lerp, smoothstep};
use std::ops::Range;
use surface::{Look, SurfacePoint};

/// Shades whole frames; owns the shadow maps and row buffers.
pub struct Shader {
    screen: Screen,
    view: View,
    light: Light,
    haze: Vec3,
    shadows: shadow::Shadows,
    clothes: Option<Clothes>,
    row: Vec<Vec3>,
    scratch: Vec<u8>,
    tone: tone::ToneCurve,
}

/// The camera for shading, f32.
#[derive(Clone, Copy, Debug)]
struct View {
    position: Vec3,
    /// Direction through pixel coordinates (0, 0), depth 1.
    corner: Vec3,
    /// Its change per pixel to the right and down.
    across: Vec3,
    down: Vec3,
    /// Differs from frame to frame.
    seed: u32,
}

impl Shader {
    /// A shader for one image size.
    pub fn new(screen: &Screen) -> Self {
        let pose = Pose { position_in_world: DVec3::ZERO, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };
        Self {
            screen: *screen,
            view: View::new(screen, &Eye::new(&pose)),
            light: Light::new(&crate::presets::clear_noon()),
            haze: Vec3::ZERO,
            shadows: shadow::Shadows::new(),
            clothes: None,
            row: vec![Vec3::ZERO; screen.width],
            scratch: Vec::new(),
            tone: tone::ToneCurve::new(),
        }
    }

    /// Takes over a frame's light, camera and shadows.
    pub(crate) fn prepare(
        &mut self,
        scene: &Scene,
        setup: &FrameSetup<'_>,
        eye: &Eye,
        figure: &[FigureTriangle],
        clothes: Option<Clothes>,
    ) {
        self.light = Light::new(setup.weather);
        self.view = View::new(&self.screen, eye);
        self.haze =
            self.light.horizon * (0.8 - 0.2 * self.light.rain) + self.light.zenith * 0.2 + self.light.lamp * 0.02;
        self.clothes = clothes;
        self.shadows.prepare(scene, eye, self.light.to_sun, figure);
    }

    /// Fills the RGB image from the faces seen.
    pub(crate) fn shade(
        &mut self,
        scene: &Scene,
        nearest: &Visibility,
        faces: &[DrawnFace],
        figure: &[FigureTriangle],
        images: &mut FrameImages,
    ) {
        let mut row_colours = core::mem::take(&mut self.row);
        let width = self.screen.width;
        for row in 0..self.screen.height {
            let pixels = row * width..(row + 1) * width;
            let depth = &images.depth_m[pixels.clone()];
            for_each_run(&nearest.face[pixels.clone()], |run, number| {
                if number == NO_FACE {
                    self.sky_run(scene, row, run, &mut row_colours);
                } else {
                    let context = RunContext { scene, row, depth };
                    self.face_run(&context, run, &faces[number as usize], figure, &mut row_colours);
                }
            });
            self.tone.store(&row_colours, self.light.exposure, &mut images.rgb[3 * pixels.start..3 * pixels.end]);
        }
        self.row = row_colours;
    }

    /// Rain in front of everything.
    pub(crate) fn overlay(&mut self, images: &mut FrameImages) {
        sky::rain(&self.light, self.view.seed, images);
    }

    /// A buffer for passes over the finished image.
    pub(crate) fn scratch(&mut self) -> &mut Vec<u8> {
        &mut self.scratch
    }

    fn sky_run(&self, scene: &Scene, row: usize, run: Range<usize>, colours: &mut [Vec3]) {
        for column in run {
            let direction = self.view.ray(column, row).normalize();
            colours[column] = sky::colour(&self.light, direction, &scene.noise);
        }
    }

    fn face_run(
        &self,
        context: &RunContext<'_>,
        run: Range<usize>,
        face: &DrawnFace,
        figure: &[FigureTriangle],
        colours: &mut [Vec3],
    ) {
        let (noise, light) = (&context.scene.noise, &self.light);
        match face.source {
            FaceSource::Ground { cluster, triangle } => {
                let ground = context.scene.clusters[cluster as usize].triangles[usize::from(triangle)];
                let plane = FacePlane::flat(ground.normal_in_world.as_vec3a());
                let label = ground.label;
                let sparse = !matches!(label, SemanticLabel::SideWalks | SemanticLabel::RoadLine);
                // Rain soaks into grass: no puddles there.
                let wettable = label != SemanticLabel::Terrain;
                self.shade_run(context, run, &plane, (wettable, sparse), colours, |point| {
                    ground::look(point, label, noise)
                });
            }
            FaceSource::Figure { triangle } => {
                let part = &figure[triangle as usize];
                let plane = FacePlane::flat(part.normal_in_world.as_vec3a());
                let colour = self.clothes.map_or([0.5; 3], |clothes| clothes.colours[part.region as usize]);
                self.shade_run(context, run, &plane, (false, false), colours, |point| {
                    let cloth = noise.grain(point.world.x * 40.0, point.world.z * 40.0, point.footprint_m * 40.0);
                    Look::matt(Vec3::from_array(colour) * (0.85 + 0.3 * cloth), point.normal)
                });
            }
            FaceSource::Box { index, face } => {
                let b = &context.scene.boxes[index as usize];
                self.box_run(context, run, b, usize::from(face), light, colours);
            }
        }
    }

    fn box_run(
        &self,
        context: &RunContext<'_>,
        run: Range<usize>,
        b: &SceneBox,
        face: usize,
        light: &Light,
        colours: &mut [Vec3],
    ) {
        let noise = &context.scene.noise;
        let axis = BOX_FACES[face].0;
        let center = b.center_in_world.as_vec3a();
        let (x_axis, y_axis) = (b.axes_in_world[0].as_vec3a(), b.axes_in_world[1].as_vec3a());
        let half = b.half_extents_m;
        let along_axis = if axis == 0 { y_axis } else { x_axis };
        let up_axis = if axis == 2 { y_axis } else { Vec3::Z };
        let normal = b.normal_in_world(face).as_vec3a();
        let plane = FacePlane { normal, along: along_axis, up: up_axis };
        if b.kind == ObstacleKind::Building && axis == 2 {
            self.shade_run(context, run, &plane, (true, false), colours, |point| {
                let away = point.world - center;
                facade::roof(point, b.seed, [away.dot(x_axis), away.dot(y_axis)], [half.x, half.y], noise)
            });
        } else if b.kind == ObstacleKind::Building {
            let half_width = if axis == 0 { half.y } else { half.x };
            let facade = facade::Facade::new(b.seed, face as u32, 2.0 * half_width, 2.0 * half.z);
            self.shade_run(context, run, &plane, (false, false), colours, |point| {
                let away = point.world - center;
                facade.look(point, away.dot(along_axis) + half_width, away.z + half.z, light, noise)
            });
        } else {
            let kind = b.kind;
            self.shade_run(context, run, &plane, (false, false), colours, |point| {
                let away = point.world - center;
                let local = Vec3::new(away.dot(x_axis), away.dot(y_axis), away.z);
                let place = things::BoxPlace { local, half, seed: b.seed, axis, whole: b.whole };
                things::look(kind, point, &place, light, noise)
            });
        }
    }

    /// Shades the pixels of one face in one row. `sparse` surfaces have no sharp patterns: every other pixel, in a
    /// chequerboard, is the mean of its neighbours.
    #[inline(always)]
    fn shade_run(
        &self,
        context: &RunContext<'_>,
        run: Range<usize>,
        plane: &FacePlane,
        (wettable, sparse): (bool, bool),
        colours: &mut [Vec3],
        look_at: impl Fn(&SurfacePoint) -> Look,
    ) {
        let mut start = run.start;
        let mut first = self.slow_part(context, start, plane);
        let normal = if first.facing > 0.0 { -plane.normal } else { plane.normal };
        while start < run.end {
            let end = (start + BLOCK).min(run.end);
            let ahead = end.min(run.end - 1);
            let last = if ahead > start { self.slow_part(context, ahead, plane) } else { first };
            let step = 1.0 / (ahead - start).max(1) as i32 as f32;
            let mut sunlight = 0.0;
            let mut is_fresh = false;
            for column in start..end {
                let skipped = |column: usize| column > start && column + 1 < end && (column + context.row) % 2 == 1;
                if sparse && skipped(column) {
                    continue;
                }
                let slow = first.lerp(&last, (column - start) as i32 as f32 * step);
                let ray = self.view.ray(column, context.row);
                let world = self.view.position + ray * context.depth[column];
                let [along, up, sky, lamps] = slow.values.to_array();
                let point = SurfacePoint {
                    world,
                    normal,
                    footprint_m: 0.5 * (along + up).min(4.0 * along.min(up)),
                    footprints_m: [along, up],
                };
                let look = look_at(&point);
                let toward = look.normal.dot(self.light.to_sun);
                // Shadows matter where the sun can shine: there, on every other pixel of a block and its last one.
                let is_asked = !is_fresh || sparse || (column - start).is_multiple_of(2) || column + 1 == end;
                if toward <= 0.0 {
                    is_fresh = false;
                } else if is_asked {
                    sunlight = self.shadows.sunlight(world, normal, &context.scene.noise);
                    is_fresh = true;
                }
                let direct = self.light.sun * (toward.max(0.0) * sunlight);
                let colour = self.lit(context.scene, &point, &look, ray, [sky, lamps], direct, wettable);
                colours[column] = colour * slow.kept + self.haze * (1.0 - slow.kept);
                if sparse && column >= start + 2 && skipped(column - 1) {
                    colours[column - 1] = (colours[column - 2] + colours[column]) * 0.5;
                }
            }
            (start, first) = (end, last);
        }
    }

    /// What changes slowly over a surface: pixel size on it, openness to the sky, lamp light.
    #[inline(always)]
    fn slow_part(&self, context: &RunContext<'_>, column: usize, plane: &FacePlane) -> SlowPart {
        let ray = self.view.ray(column, context.row);
        let depth = context.depth[column];
        let world = self.view.position + ray * depth;
        let facing = ray.dot(plane.normal);
        // One pixel aside moves over the plane by the step, slid along the ray until it stays in the plane.
        let slide = |step: Vec3| (step - ray * (step.dot(plane.normal) / facing)) * depth;
        let (a, b) = (slide(self.view.across), slide(self.view.down));
        let normal = if facing > 0.0 { -plane.normal } else { plane.normal };
        let off_wall = world + normal * (1.2 * (1.0 - normal.z.abs()));
        let grid = context.scene.grid.sample(off_wall.x, off_wall.y);
        let far = (depth * ray.dot(ray).sqrt() - self.light.haze_start_m).max(0.0);
        let above = world.z - grid.ground_m;
        let sky = 0.36 + 0.64 * (grid.sky + (1.0 - grid.sky) * (above * 0.045).clamp(0.0, 0.85));
        let lamps = grid.lamps * (1.0 - above * 0.11).max(0.0);
        let along_m = a.dot(plane.along).abs() + b.dot(plane.along).abs();
        let up_m = a.dot(plane.up).abs() + b.dot(plane.up).abs();
        SlowPart { values: Vec4::new(along_m, up_m, sky, lamps), kept: fast_exp(-self.light.haze_per_m * far), facing }
    }

    /// Light that a surface point sends to the camera.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "everything that light depends on, once")]
    fn lit(
        &self,
        scene: &Scene,
        point: &SurfacePoint,
        look: &Look,
        ray: Vec3,
        [open_sky, lamps]: [f32; 2],
        direct: Vec3,
        wettable: bool,
    ) -> Vec3 {
        let light = &self.light;
        let lamp_share = lamps * (0.75 + 0.25 * look.normal.z);
        let arriving = direct + light.ambient(look.normal) * (open_sky * look.openness) + light.lamp * lamp_share;
        let (mut albedo, mut mirror, mut reflecting) = (look.albedo, look.mirror, look.normal);
        if wettable && light.wet > 0.0 && point.normal.z > 0.9 {
            let level = scene.noise.clumps(point.world.x * 2.1, point.world.y * 2.1, point.footprint_m * 2.1);
            let edge = 0.82 - 0.32 * light.puddles;
            let puddle = smoothstep(edge, edge + 0.05, level) * light.wet;
            albedo *= 1.0 - 0.42 * light.wet - 0.10 * puddle;
            mirror = mirror.max(0.10 * light.wet + 0.45 * puddle);
            reflecting = point.normal;
        }
        let mut colour = albedo * arriving + look.emission;
        if mirror > 0.003 {
            let view = ray * ray.dot(ray).sqrt().recip();
            let cosine = (-view.dot(reflecting)).clamp(0.0, 1.0);
            let grazing = 1.0 - cosine;
            let fresnel = 0.05 + 0.95 * grazing * grazing * grazing * grazing * grazing;
            let out = view + reflecting * (2.0 * cosine);
            let share = (mirror * (0.30 + 0.9 * fresnel)).min(0.85);
            // Near the horizon a street mirrors its houses more than the sky.
            let open = open_sky * (0.30 + 0.70 * (2.2 * out.z).clamp(0.0, 1.0));
            let seen = light.sky(out) * open + arriving * 0.10 + light.lamp * (0.6 * lamp_share);
            colour = colour * (1.0 - share) + seen * share;
        }
        colour
    }
}

/// e^x for x <= 0, to about 1e-4: (1 + x/256)^256.
#[inline(always)]
fn fast_exp(x: f32) -> f32 {
    let mut base = (1.0 + x * (1.0 / 256.0)).max(0.0);
    for _ in 0..8 {
        base *= base;
    }
    base
}

/// Pixels over which slow changes are taken as linear.
const BLOCK: usize = 12;

/// What changes slowly over a surface.
#[derive(Clone, Copy)]
struct SlowPart {
    /// Size of a pixel along the surface and up it, metres; openness to the sky; light of lamps.
    values: Vec4,
    /// Share of light that haze lets through.
    kept: f32,
    /// Cosine-like: negative where the plane's normal points to the camera.
    facing: f32,
}

impl SlowPart {
    #[inline(always)]
    fn lerp(&self, other: &Self, t: f32) -> Self {
        Self {
            values: self.values + (other.values - self.values) * t,
            kept: lerp(self.kept, other.kept, t),
            facing: self.facing,
        }
    }
}

/// What a run of pixels needs besides its face.
struct RunContext<'a> {
    scene: &'a Scene,
    row: usize,
    depth: &'a [f32],
}

/// Normal of a face, and its own horizontal and vertical.
struct FacePlane {
    normal: Vec3,
    along: Vec3,
    up: Vec3,
}

impl FacePlane {
    fn flat(normal: Vec3) -> Self {
        Self { normal, along: Vec3::X, up: Vec3::Y }
    }
}

impl View {
    fn new(screen: &Screen, eye: &Eye) -> Self {
        let [forward, right, up] = [eye.world_from_body.x_axis, eye.world_from_body.y_axis, eye.world_from_body.z_axis];
        let across = right / screen.focal_px;
        let down = -up / screen.focal_px;
        let corner = forward - across * screen.center_u - down * screen.center_v;
        let position = eye.position_in_world;
        let seed = [position.x, position.y, position.z, forward.x, forward.y].iter().fold(17, |seed, value| {
            let bits = value.to_bits();
            hash(hash(seed, bits as u32), (bits >> 32) as u32)
        });
        Self {
            position: position.as_vec3a(),
            corner: corner.as_vec3a(),
            across: across.as_vec3a(),
            down: down.as_vec3a(),
            seed,
        }
    }

    /// Direction through a pixel's centre, of length 1 along the optical axis.
    #[inline(always)]
    fn ray(&self, column: usize, row: usize) -> Vec3 {
        self.corner + self.across * (column as i32 as f32 + 0.5) + self.down * (row as i32 as f32 + 0.5)
    }
}
