//! Bands of rows: pixels gathered by face, taken through the kernels, put back.

use super::facade::{BoxFace, Facade, Roof, facade, roofs};
use super::geometry::{FaceAxes, place};
use super::ground::ground;
use super::lanes::{BLOCKS, Block, LANES, Stage, WIDE, get};
use super::light::Light;
use super::lighting::{self, Answers};
use super::pattern::{NoiseTexture, Noises, share};
use super::surface::Look;
use super::things::{Thing, swell, things};
use super::vector::Vec3;
use super::{Seen, Shader};
use crate::passes::ids::{Band, Run};
use crate::renderer::{DrawnFace, FaceSource};
use crate::scene::{BOX_FACES, SceneBox};
use crate::visibility::NO_FACE;
use cosfly_frames::simd_kernel;
use cosfly_maps::{ObstacleKind, SemanticLabel};
use std::sync::PoisonError;

/// Groups of pixels that are not of a single face: the sky, and ground by label.
const SKY: usize = 63;
const SHARED_GROUPS: usize = 64;
/// No run follows.
const END: u32 = u32::MAX;

/// What one thread needs to shade bands.
pub(crate) struct Worker {
    stage: Box<Stage>,
    blocks: Box<[Block; BLOCKS]>,
    /// Bytes of the blocks' pixels, in a row.
    developed: Box<[u32; LANES + WIDE]>,
    runs: Vec<Link>,
    /// First run of each group; [`END`] between bands.
    first: Vec<u32>,
    /// Groups that have runs.
    present: Vec<u32>,
    pieces: Vec<Piece>,
}

/// A run of pixels, and the next one of its group.
#[derive(Clone, Copy)]
struct Link {
    run: Run,
    next: u32,
}

/// Pixels of a run that went into the blocks.
#[derive(Clone, Copy)]
struct Piece {
    start: usize,
    lane: usize,
    length: usize,
}

/// What the pixels of a group are made of.
enum Material {
    Sky,
    Ground(SemanticLabel),
    Facade(Facade, BoxFace),
    Roof(Roof),
    Thing(Thing),
    Cloth(Cloth),
}

/// Shades a band from its runs and depth: the picture, and the same as bytes.
pub(super) fn shade(shader: &Shader, seen: &Seen<'_>, band: &mut Band<'_>) {
    let idle = || shader.idle.lock().unwrap_or_else(PoisonError::into_inner);
    let mut worker = idle().pop().unwrap_or_else(Worker::new);
    worker.shade(shader, seen, band);
    bytes(shader.level, band.picture, band.rgb);
    idle().push(worker);
}

simd_kernel! {
    /// Pixels in the low three bytes of numbers, as bytes.
    fn bytes(pixels: &[u32], rgb: &mut [u8]) {
        let (fours, rest) = pixels.as_chunks::<4>();
        let (twelves, rest_rgb) = rgb.as_chunks_mut::<12>();
        for (four, twelve) in fours.iter().zip(twelves) {
            let [a, b, c, d] = *four;
            let three = [a | b << 24, b >> 8 | c << 16, c >> 16 | d << 8];
            let (out, _) = twelve.as_chunks_mut::<4>();
            for (bytes, value) in out.iter_mut().zip(three) {
                *bytes = value.to_le_bytes();
            }
        }
        for (pixel, rgb) in rest.iter().zip(rest_rgb.chunks_exact_mut(3)) {
            rgb.copy_from_slice(&pixel.to_le_bytes()[..3]);
        }
    }
}

impl Worker {
    fn new() -> Self {
        Self {
            stage: Box::new(Stage::EMPTY),
            blocks: Box::new([Block::EMPTY; BLOCKS]),
            developed: Box::new([0; LANES + WIDE]),
            runs: Vec::new(),
            first: Vec::new(),
            present: Vec::new(),
            pieces: Vec::with_capacity(LANES),
        }
    }

    fn shade(&mut self, shader: &Shader, seen: &Seen<'_>, band: &mut Band<'_>) {
        self.gather(seen, band);
        for position in 0..self.present.len() {
            let group = self.present[position] as usize;
            self.shade_group(shader, seen, band, group);
            self.first[group] = END;
        }
        self.present.clear();
        self.runs.clear();
    }

    /// Lists the band's runs by group; neighbours in a row that are alike to the kernels become one.
    fn gather(&mut self, seen: &Seen<'_>, band: &Band<'_>) {
        let groups = SHARED_GROUPS + seen.faces.len();
        if self.first.len() < groups {
            self.first.resize(groups, END);
        }
        let mut last_group = usize::MAX;
        for run in band.runs.iter() {
            let group = group_of(seen.faces, run.face);
            if group == last_group
                && group < SKY
                && let Some(last) = self.runs.last_mut()
                && !(run.start as usize).is_multiple_of(band.width)
                && normal_of(seen, last.run.face) == normal_of(seen, run.face)
            {
                last.run.length += run.length;
                continue;
            }
            last_group = group;
            let next = self.first[group];
            if next == END {
                self.present.push(group as u32);
            }
            self.first[group] = self.runs.len() as u32;
            self.runs.push(Link { run: *run, next });
        }
    }

    fn shade_group(&mut self, shader: &Shader, seen: &Seen<'_>, band: &mut Band<'_>, group: usize) {
        let mut next = self.first[group];
        let first = self.runs[next as usize].run;
        let (material, axes) = material_of(shader, seen, first.face);
        let is_ground = group < SHARED_GROUPS;
        let mut lanes = 0;
        if !is_ground {
            let normal = normal_of(seen, first.face);
            for (row, value) in self.stage.normal.iter_mut().zip([normal.x, normal.y, normal.z]) {
                row.fill(value);
            }
        }
        while next != END {
            let Link { run, next: after } = self.runs[next as usize];
            next = after;
            let (mut start, end) = (run.start as usize, (run.start + run.length) as usize);
            let normal = if is_ground { normal_of(seen, run.face) } else { Vec3::ZERO };
            while start < end {
                let length = (end - start).min(LANES - lanes);
                let piece = Piece { start, lane: lanes, length };
                self.fill(band, piece, is_ground.then_some(normal));
                self.pieces.push(piece);
                lanes += length;
                start += length;
                if lanes == LANES {
                    self.flush(shader, seen, &material, &axes, lanes, band.picture);
                    lanes = 0;
                }
            }
        }
        if lanes > 0 {
            self.flush(shader, seen, &material, &axes, lanes, band.picture);
        }
    }

    /// Puts a piece of a run on the stage, sixteen pixels at a time: what is too much, the next piece writes over.
    #[inline]
    fn fill(&mut self, band: &Band<'_>, piece: Piece, normal: Option<Vec3>) {
        let column = piece.start % band.width;
        let v = (band.first_row + piece.start / band.width) as f32 + 0.5;
        let u = column as f32 + 0.5;
        let depth_m = &band.depth_m[piece.start..];
        let stage = &mut *self.stage;
        for done in (0..piece.length).step_by(WIDE) {
            let lane = piece.lane + done;
            let lanes = lane..lane + WIDE;
            let base = u + done as f32;
            for (k, u) in stage.u[lanes.clone()].iter_mut().enumerate() {
                *u = base + k as i32 as f32;
            }
            stage.v[lanes.clone()].fill(v);
            if let (Some(depths), Some(out)) =
                (depth_m[done..].first_chunk::<WIDE>(), stage.depth_m[lane..].first_chunk_mut::<WIDE>())
            {
                *out = *depths;
            } else {
                let rest = &depth_m[done..];
                stage.depth_m[lane..lane + rest.len()].copy_from_slice(rest);
            }
            if let Some(normal) = normal {
                for (row, value) in stage.normal.iter_mut().zip([normal.x, normal.y, normal.z]) {
                    row[lanes.clone()].fill(value);
                }
            }
        }
    }

    /// Takes the filled lanes through the kernels and writes their pixels.
    fn flush(
        &mut self,
        shader: &Shader,
        seen: &Seen<'_>,
        material: &Material,
        axes: &FaceAxes,
        lanes: usize,
        picture: &mut [u32],
    ) {
        let blocks = &mut self.blocks[..lanes.div_ceil(WIDE)];
        run_kernels(shader, seen, material, axes, &self.stage, blocks);
        for (out, block) in self.developed.as_chunks_mut::<WIDE>().0.iter_mut().zip(blocks.iter()) {
            *out = block.bytes;
        }
        put_back(shader.level, &self.pieces, &self.developed, picture);
        self.pieces.clear();
    }
}

simd_kernel! {
    /// Copies lanes to where their pieces lie in the picture.
    fn put_back(pieces: &[Piece], developed: &[u32; LANES + WIDE], picture: &mut [u32]) {
        for piece in pieces {
            for done in (0..piece.length).step_by(WIDE) {
                let (lane, at) = (piece.lane.wrapping_add(done), piece.start.wrapping_add(done));
                let left = piece.length.wrapping_sub(done);
                if let (Some(lanes), Some(out)) = (
                    developed.get(lane..).and_then(|rest| rest.first_chunk::<WIDE>()),
                    picture.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<WIDE>()),
                ) {
                    if left >= WIDE {
                        *out = *lanes;
                    } else {
                        let old = *out;
                        for k in 0..WIDE {
                            let taken = 0u32.wrapping_sub(u32::from((k as u32) < left as u32));
                            out[k] = (lanes[k] & taken) | (old[k] & !taken);
                        }
                    }
                } else if let Some(out) = picture.get_mut(at..at.wrapping_add(left)) {
                    for (out, lane) in out.iter_mut().zip(&developed[lane..]) {
                        *out = *lane;
                    }
                }
            }
        }
    }
}

fn run_kernels(
    shader: &Shader,
    seen: &Seen<'_>,
    material: &Material,
    axes: &FaceAxes,
    stage: &Stage,
    blocks: &mut [Block],
) {
    let (level, light, noise) = (shader.level, &shader.light, &seen.scene.noise);
    if let Material::Sky = material {
        lighting::sky(level, blocks, stage, &shader.view, light, noise);
        lighting::develop(level, blocks, light.exposure, &shader.tone);
        return;
    }
    let grid = &seen.scene.grid;
    place(level, blocks, stage, &shader.view, axes, grid.tables(), &grid.frame(), light);
    if let Material::Thing(thing) = material
        && matches!(thing.kind, ObstacleKind::TreeCrown | ObstacleKind::Bush)
    {
        swell(level, blocks, thing, shader.view.position);
    }
    if material.faces_away(stage, light) {
        blocks.iter_mut().for_each(|block| block.sunlight = [0.0; WIDE]);
    } else {
        shader.shadows.sunlight(level, blocks, noise);
    }
    if let (Material::Ground(_), Some((feet, radius_m))) = (material, shader.feet) {
        contact(level, blocks, feet, radius_m);
    }
    let answers = material.answers();
    match material {
        Material::Sky => {}
        Material::Ground(label) => ground(level, blocks, *label, noise),
        Material::Facade(look, face) => facade(level, blocks, look, face, light.night, noise),
        Material::Roof(roof) => roofs(level, blocks, roof, noise),
        Material::Thing(thing) => things(level, blocks, thing, noise),
        Material::Cloth(look) => cloth(level, blocks, look, noise),
    }
    let is_wet = answers.wettable && light.wet > 0.0;
    if is_wet {
        lighting::wet(level, blocks, light, noise);
    }
    lighting::dull(level, blocks, light);
    if light.night > 0.0 {
        lighting::lamps(level, blocks, light);
        if answers.glows {
            lighting::glow(level, blocks);
        }
    }
    if is_wet || answers.shiny {
        lighting::mirrored(level, blocks, light);
    }
    lighting::hazy(level, blocks, shader.haze);
    lighting::develop(level, blocks, light.exposure, &shader.tone);
}

fn group_of(faces: &[DrawnFace], face: u32) -> usize {
    if face == NO_FACE {
        return SKY;
    }
    let drawn = &faces[face as usize];
    match drawn.source {
        FaceSource::Ground { .. } => usize::from(drawn.label).min(SKY - 1),
        _ => SHARED_GROUPS + face as usize,
    }
}

/// Normal of a face, any side.
#[inline]
fn normal_of(seen: &Seen<'_>, face: u32) -> Vec3 {
    let [x, y, z] = seen.faces.get(face as usize).map_or([0.0; 3], |face| face.normal);
    Vec3::new(x, y, z)
}

fn material_of(shader: &Shader, seen: &Seen<'_>, face: u32) -> (Material, FaceAxes) {
    let flat = FaceAxes { along: Vec3::new(1.0, 0.0, 0.0), up: Vec3::new(0.0, 1.0, 0.0) };
    let Some(face) = seen.faces.get(face as usize) else { return (Material::Sky, flat) };
    match face.source {
        FaceSource::Ground { cluster, polygon } => {
            let polygon = seen.scene.clusters[cluster as usize].polygons[usize::from(polygon)];
            (Material::Ground(polygon.label), flat)
        }
        FaceSource::Figure { triangle } => {
            let part = &seen.figure[triangle as usize];
            let [r, g, b] = shader.clothes.map_or([0.5; 3], |clothes| clothes.colours[part.region as usize]);
            let [from, to] = part.middle_in_world.map(Vec3::from);
            (Material::Cloth(Cloth { colour: Vec3::new(r, g, b), from, along: to - from }), flat)
        }
        FaceSource::Box { index, face } => {
            box_material(&seen.scene.boxes[index as usize], usize::from(face), shader.light.night)
        }
    }
}

fn box_material(b: &SceneBox, face: usize, night: f32) -> (Material, FaceAxes) {
    let axis = BOX_FACES[face].0;
    let center: Vec3 = b.center_in_world.into();
    let axes = b.axes_in_world.map(Vec3::from);
    let half = Vec3::new(b.half_extents_m.x, b.half_extents_m.y, b.half_extents_m.z);
    let along = axes[usize::from(axis == 0)];
    let up = if axis == 2 { axes[1] } else { Vec3::new(0.0, 0.0, 1.0) };
    let material = if b.kind != ObstacleKind::Building {
        let whole = b.whole.map(|v| Vec3::new(v.x, v.y, v.z));
        Material::Thing(Thing::new(b.kind, center, axes, half, b.seed, axis, whole, night))
    } else if axis == 2 {
        Material::Roof(Roof::new(b.seed, center, axes, [half.x, half.y]))
    } else {
        let half_width = if axis == 0 { half.y } else { half.x };
        let look = Facade::new(b.seed, face as u32, 2.0 * half_width, 2.0 * half.z);
        let edge_m = center.dot(Vec3::new(along.x, along.y, 0.0)) - half_width;
        Material::Facade(look, BoxFace { along, edge_m, foot_m: center.z - half.z })
    };
    (material, FaceAxes { along, up })
}

impl Material {
    /// Whether the sun shines on the back of a flat face: no shadow matters there. Faces of boxes show their outside.
    fn faces_away(&self, stage: &Stage, light: &Light) -> bool {
        let is_flat = match self {
            Self::Facade(..) | Self::Roof(_) => true,
            Self::Thing(thing) => !matches!(thing.kind, ObstacleKind::TreeCrown | ObstacleKind::Bush),
            Self::Sky | Self::Ground(_) | Self::Cloth(_) => false,
        };
        let [x, y, z] = stage.normals(0).map(|lane| lane[0]);
        is_flat && Vec3::new(x, y, z).dot(light.to_sun) <= 0.0
    }

    fn answers(&self) -> Answers {
        let matt = Answers { wettable: false, shiny: false, glows: false };
        match self {
            // Rain soaks into grass: no puddles there.
            Self::Ground(label) => {
                let shiny = *label == SemanticLabel::Water;
                Answers { wettable: *label != SemanticLabel::Terrain, shiny, glows: false }
            }
            Self::Facade(..) => Answers { wettable: false, shiny: true, glows: true },
            Self::Roof(_) => Answers { wettable: true, shiny: false, glows: false },
            Self::Thing(thing) => match thing.kind {
                ObstacleKind::Car | ObstacleKind::Lamp | ObstacleKind::TrafficLight | ObstacleKind::Pole => {
                    Answers { wettable: false, shiny: true, glows: true }
                }
                _ => matt,
            },
            Self::Sky | Self::Cloth(_) => matt,
        }
    }
}

/// A part of a figure.
#[derive(Clone, Copy, Debug)]
struct Cloth {
    colour: Vec3,
    /// Its middle line.
    from: Vec3,
    along: Vec3,
}

simd_kernel! {
    /// Clothes, skin and hair, round around the part's middle line.
    fn cloth(blocks: &mut [Block], look: &Cloth, noise: &NoiseTexture) {
        let Cloth { colour, from, along } = *look;
        let per_length2 = 1.0 / (along.dot(along) + 1e-9);
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let point = block.point(k);
                let weave = noise.grain(point.world.x * 40.0, point.world.z * 40.0, point.footprint_m * 40.0);
                let fold = noise.clumps(point.world.x * 55.0, point.world.z * 35.0, point.footprint_m * 45.0);
                let away = point.world - from;
                let round = (away - along * share(away.dot(along) * per_length2)).unit();
                let normal = (round + point.normal * 0.4).unit();
                block.put(k, &Look::matt(colour * (0.62 + 0.25 * weave + 0.5 * fold), normal));
            }
        }
    }
}

simd_kernel! {
    /// Less sky where something stands on the ground: around `feet`, `radius_m` wide.
    fn contact(blocks: &mut [Block], feet: Vec3, radius_m: f32) {
        let per_radius2 = 1.0 / (radius_m * radius_m);
        for block in blocks.iter_mut() {
            let mut near = 0u32;
            for k in 0..WIDE {
                let away = get(&block.world, k) - feet;
                near |= u32::from(away.dot(away) * per_radius2 < 9.0);
            }
            if near != 0 {
                for k in 0..WIDE {
                    let away = get(&block.world, k) - feet;
                    let shade = share(1.0 - away.dot(away) * per_radius2 * (1.0 / 9.0));
                    let kept = 1.0 - 0.55 * shade * shade * shade;
                    block.sky[k] *= kept;
                    block.lamps[k] *= kept;
                }
            }
        }
    }
}
