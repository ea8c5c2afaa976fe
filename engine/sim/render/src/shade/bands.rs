//! Bands of rows: pixels gathered by face, taken through the kernels, put back.

use super::cloth::cloth;
use super::facade::{facade, lift, roofs, tiles};
use super::geometry::{FaceAxes, open, place, points};
use super::ground::ground;
use super::lanes::{Block, FOUR, FOURS, GROUPS, LANES, Shared, Stage, WIDE, get};
use super::lighting;
use super::material::{Material, coach, material_of};
use super::pattern::{most, share};
use super::setting::{Seen, Setting};
use super::simple;
use super::skin::painted;
use super::things::{swell, things};
use super::vector::Vec3;
use crate::faces::{DrawnFace, FaceSource};
use crate::look::PictureLook;
use crate::passes::ids::{Band, Run};
use crate::visibility::{NO_FACE, PlaneOnScreen};
use cosfly_figures::BodyShape;
use cosfly_frames::{real, simd_kernel};

/// Groups of pixels that are not of a single face: the sky, and ground by label. Faces of one part of a body are a group,
/// too, named after the first of them.
const SKY: usize = 63;
const SHARED_GROUPS: usize = 64;
/// No run follows.
const END: u32 = u32::MAX;

/// Buffers of one thread that shades bands.
pub(crate) struct Worker {
    stage: Box<Stage>,
    shared: Box<[Shared; GROUPS]>,
    blocks: Box<[Block; FOUR * GROUPS]>,
    /// Bytes of the blocks' pixels, in a row.
    developed: Box<[u32; LANES + WIDE]>,
    /// The band's pixels: red in the lowest byte, then green and blue.
    picture: Vec<u32>,
    runs: Vec<Link>,
    /// First run of each group; [`END`] between bands.
    first: Vec<u32>,
    /// Groups that have runs.
    present: Vec<u32>,
    pieces: Vec<Piece>,
    /// Numbers of the people who may darken something in the band, and of those among the pieces.
    near_band: Vec<u32>,
    near: Vec<u32>,
}

/// A run of pixels, and the next one of its group.
#[derive(Clone, Copy)]
struct Link {
    run: Run,
    next: u32,
}

/// Pixels of a run that go into the blocks, from the first pixel of a four, and the plane of their face.
#[derive(Clone, Copy)]
struct Piece {
    /// First pixel, from the start of the band.
    start: usize,
    /// Place of that pixel in the blocks.
    lane: usize,
    /// Pixels.
    length: usize,
    /// The first pixel's centre.
    u: f32,
    v: f32,
    /// Inverse depth there, 1/m, and its changes per pixel.
    inverse: f32,
    across: f32,
    down: f32,
    /// Unit normal of the face, any side.
    normal: [f32; 3],
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
    pub fn new() -> Self {
        Self {
            stage: Box::new(Stage::EMPTY),
            shared: Box::new([Shared::EMPTY; GROUPS]),
            blocks: Box::new([Block::EMPTY; FOUR * GROUPS]),
            developed: Box::new([0; LANES + WIDE]),
            picture: Vec::new(),
            runs: Vec::new(),
            first: Vec::new(),
            present: Vec::new(),
            pieces: Vec::with_capacity(FOURS),
            near_band: Vec::new(),
            near: Vec::new(),
        }
    }

    /// Shades a band from its runs.
    pub fn shade(&mut self, setting: &Setting, seen: &Seen<'_>, band: &mut Band<'_>) {
        self.picture.resize(band.rgb.len() / 3, 0);
        self.gather(seen, band);
        let rows = band.first_row..band.first_row + self.picture.len() / band.width.max(1);
        let people = (0u32..).zip(&seen.people.members);
        self.near_band.clear();
        self.near_band.extend(people.filter(|(_, person)| person.reach.meets_rows(rows.clone())).map(|(k, _)| k));
        for position in 0..self.present.len() {
            let group = self.present[position] as usize;
            self.shade_group(setting, seen, band, group);
            self.first[group] = END;
        }
        self.present.clear();
        self.runs.clear();
        bytes(setting.level, &self.picture, band.rgb);
    }

    /// Lists the band's runs by group; neighbours in a row that are alike to the kernels become one.
    fn gather(&mut self, seen: &Seen<'_>, band: &Band<'_>) {
        let groups = SHARED_GROUPS + seen.faces.len();
        if self.first.len() < groups {
            self.first.resize(groups, END);
        }
        let mut last_group = usize::MAX;
        for run in &band.runs.all {
            let group = group_of(seen.faces, run.face);
            if group == last_group
                && group < SKY
                && let Some(last) = self.runs.last_mut()
                && !(run.start as usize).is_multiple_of(band.width)
                && are_one_plane(seen, band, &last.run, run)
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

    fn shade_group(&mut self, setting: &Setting, seen: &Seen<'_>, band: &Band<'_>, group: usize) {
        let mut next = self.first[group];
        let first = self.runs[next as usize].run;
        let (material, axes) = material_of(setting, seen, first.face);
        let mut lanes = 0;
        while next != END {
            let Link { run, next: after } = self.runs[next as usize];
            next = after;
            let (on_screen, normal) = plane_of(seen, run.face);
            let (mut start, end) = (run.start as usize, (run.start + run.length) as usize);
            while start < end {
                let length = (end - start).min(LANES - lanes);
                let (u, v) = center_of(band, start);
                self.pieces.push(Piece {
                    start,
                    lane: lanes,
                    length,
                    u: u as f32,
                    v: v as f32,
                    inverse: on_screen.at(u, v) as f32,
                    across: on_screen.across as f32,
                    down: on_screen.down as f32,
                    normal,
                });
                lanes += length.next_multiple_of(FOUR);
                start += length;
                if lanes == LANES {
                    self.flush(setting, seen, &material, &axes, lanes);
                    lanes = 0;
                }
            }
        }
        if lanes > 0 {
            self.flush(setting, seen, &material, &axes, lanes);
        }
    }

    /// Lists who may darken a pixel of the pieces.
    fn find_near(&mut self, seen: &Seen<'_>) {
        self.near.clear();
        if self.near_band.is_empty() {
            return;
        }
        let place = |piece: &Piece| {
            let column = piece.u as usize;
            (piece.v as usize, column..column + piece.length)
        };
        let columns = self.pieces.iter().map(|piece| place(piece).1);
        let around = columns.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or(0..0);
        let rows = self.pieces.iter().map(|piece| place(piece).0..place(piece).0 + 1);
        let rows = rows.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or(0..0);
        for person in &self.near_band {
            let reach = &seen.people.members[*person as usize].reach;
            if reach.meets(rows.clone(), around.clone())
                && self.pieces.iter().map(place).any(|(row, columns)| reach.meets(row..row + 1, columns))
            {
                self.near.push(*person);
            }
        }
    }

    /// Takes the filled lanes through the kernels and writes their pixels.
    fn flush(&mut self, setting: &Setting, seen: &Seen<'_>, material: &Material, axes: &FaceAxes, lanes: usize) {
        let groups = lanes.div_ceil(FOUR * WIDE);
        self.find_near(seen);
        fill(setting.level, &self.pieces, &mut self.stage);
        let (shared, blocks) = (&mut self.shared[..groups], &mut self.blocks[..FOUR * groups]);
        let blocks = (shared, blocks);
        match setting.look {
            PictureLook::Full => run_kernels(setting, seen, material, axes, &self.stage, blocks, &self.near),
            PictureLook::Simple => run_simple_kernels(setting, material, axes, &self.stage, blocks),
        }
        put_back(setting.level, &self.pieces, &self.blocks[..FOUR * groups], &mut self.developed, &mut self.picture);
        self.pieces.clear();
    }
}

/// Coordinates of the centre of a band's pixel.
#[inline]
fn center_of(band: &Band<'_>, pixel: usize) -> (f64, f64) {
    let (column, row) = ((pixel % band.width) as u32, (band.first_row + pixel / band.width) as u32);
    (f64::from(column) + 0.5, f64::from(row) + 0.5)
}

/// The plane of a face and its normal; any for the sky.
#[inline]
fn plane_of(seen: &Seen<'_>, face: u32) -> (PlaneOnScreen, [f32; 3]) {
    let far = PlaneOnScreen { constant: 1.0, across: 0.0, down: 0.0 };
    seen.faces.get(face as usize).map_or((far, [0.0; 3]), |face| (face.plane, face.normal))
}

/// Whether neighbouring runs of ground go on in one plane: its kernels know no other difference.
fn are_one_plane(seen: &Seen<'_>, band: &Band<'_>, left: &Run, right: &Run) -> bool {
    let ((left, left_normal), (plane, normal)) = (plane_of(seen, left.face), plane_of(seen, right.face));
    let (u, v) = center_of(band, right.start as usize);
    let near = |u: f64| (left.at(u, v) - plane.at(u, v)).abs() < 1e-4 * plane.at(u, v);
    left_normal == normal && near(u) && near(u + f64::from(right.length))
}

simd_kernel! {
    /// Puts pieces of runs on the stage, sixteen fours at a time: what is too much, the next piece writes over.
    fn fill(pieces: &[Piece], stage: &mut Stage) {
        for piece in pieces {
            let step = FOUR as f32 * piece.across;
            let first = piece.lane / FOUR;
            for done in (0..piece.length.div_ceil(FOUR)).step_by(WIDE) {
                let fours = first.wrapping_add(done)..first.wrapping_add(done).wrapping_add(WIDE);
                let aside = (FOUR.wrapping_mul(done)) as i32 as f32;
                let (from_u, inverse) = (piece.u + aside, piece.inverse + piece.across * aside);
                let (mut u, mut inverses) = ([0.0; WIDE], [0.0; WIDE]);
                for k in 0..WIDE {
                    let aside = k as i32 as f32;
                    u[k] = from_u + FOUR as f32 * aside;
                    inverses[k] = inverse + step * aside;
                }
                let [x, y, z] = &mut stage.normal;
                for (row, values) in [(&mut stage.u, u), (&mut stage.inverse, inverses)] {
                    row[fours.clone()].copy_from_slice(&values);
                }
                for (row, value) in [
                    (&mut stage.v, piece.v),
                    (&mut stage.across, piece.across),
                    (&mut stage.down, piece.down),
                    (x, piece.normal[0]),
                    (y, piece.normal[1]),
                    (z, piece.normal[2]),
                ] {
                    row[fours.clone()].copy_from_slice(&[value; WIDE]);
                }
            }
        }
    }
}

simd_kernel! {
    /// Copies lanes to where their pieces lie in the picture. `developed` is room for their bytes in a row.
    fn put_back(pieces: &[Piece], blocks: &[Block], developed: &mut [u32; LANES + WIDE], picture: &mut [u32]) {
        for (four, out) in blocks.as_chunks::<FOUR>().0.iter().zip(developed.as_chunks_mut::<{ FOUR * WIDE }>().0) {
            let [a, b, c, d] = four.each_ref().map(|block| &block.bytes);
            for k in 0..WIDE {
                out[FOUR * k] = a[k];
                out[FOUR * k + 1] = b[k];
                out[FOUR * k + 2] = c[k];
                out[FOUR * k + 3] = d[k];
            }
        }
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
    setting: &Setting,
    seen: &Seen<'_>,
    material: &Material,
    axes: &FaceAxes,
    stage: &Stage,
    (shared, blocks): (&mut [Shared], &mut [Block]),
    near: &[u32],
) {
    let (level, light, noise) = (setting.level, &setting.light, &seen.scene.noise);
    if let Material::Sky = material {
        let air = (light, setting.haze, &seen.scene.outskirts);
        lighting::sky(level, blocks, stage, &setting.view, air, &setting.tone, noise);
        return;
    }
    let grid = &seen.scene.grid;
    place(level, shared, stage, &setting.view, axes, light);
    points(level, shared, blocks, stage, &setting.view);
    open(level, shared, grid.tables(), &grid.frame(), light.night > 0.0);
    if let Material::Ground(_) = material {
        for person in near {
            let walker = &seen.people.members[*person as usize].walker;
            let feet = walker.state.feet_in_world.into();
            match walker.body {
                BodyShape::Person => contact(level, shared, feet, walker.radius_m.clamp(0.1, 2.0) as f32),
                BodyShape::Vehicle { size_m, .. } => {
                    let (sin, cos) = real::sin_cos(walker.state.heading_rad);
                    let half_m = 0.5 * size_m.truncate().as_vec2();
                    contact_below(level, shared, feet, [cos as f32, sin as f32], half_m.to_array());
                }
            }
        }
    }
    let is_bent = material.is_bent();
    if let Material::Thing(thing) = material
        && is_bent
    {
        swell(level, blocks, thing, setting.view.position);
    }
    if let Material::Tiles(_) = material {
        lift(level, blocks);
    }
    if material.faces_away(stage, light) {
        blocks.iter_mut().for_each(|block| block.sunlight = [0.0; WIDE]);
    } else {
        setting.shadows.sunlight(level, blocks, !is_bent, noise, near);
    }
    match material {
        Material::Sky => {}
        Material::Ground(label) => ground(level, shared, blocks, *label, (grid.tables(), &grid.frame()), noise),
        Material::Facade(look, face) => facade(level, shared, blocks, look, face, light, noise),
        Material::Roof(roof) => roofs(level, shared, blocks, roof, light, noise),
        Material::Tiles(slope) => tiles(level, shared, blocks, slope, noise),
        Material::Thing(thing) => things(level, shared, blocks, thing, noise),
        Material::Cloth(look) => cloth(level, shared, blocks, look, noise),
        Material::Coach(look) => coach(level, blocks, look),
        Material::Skin(look) => painted(shared, blocks, look, &seen.scene.props.textures),
    }
    lighting::arriving(level, shared, light, setting.haze);
    if is_bent {
        lighting::develop_bent(level, shared, blocks, light, &setting.tone);
        return;
    }
    let answers = material.answers();
    let is_wet = answers.wettable && light.wet > 0.0;
    if is_wet {
        lighting::wet(level, shared, blocks, light, noise);
    }
    let is_shiny = is_wet || answers.shiny;
    if is_shiny {
        lighting::mirrored(level, shared, light, (grid.tables(), &grid.frame()));
    }
    lighting::develop(level, shared, blocks, light, &setting.tone, answers.glows && light.night > 0.0, is_shiny);
}

/// Draws a group in the simple look.
fn run_simple_kernels(
    setting: &Setting,
    material: &Material,
    axes: &FaceAxes,
    stage: &Stage,
    (shared, blocks): (&mut [Shared], &mut [Block]),
) {
    let (level, light, tone) = (setting.level, &setting.light, &setting.tone);
    if let Material::Sky = material {
        simple::sky(level, blocks, stage, &setting.view, light, tone);
        return;
    }
    place(level, shared, stage, &setting.view, axes, light);
    simple::open_sky(level, shared);
    lighting::arriving(level, shared, light, setting.haze);
    match material {
        Material::Facade(look, face) => {
            points(level, shared, blocks, stage, &setting.view);
            simple::windows(level, shared, blocks, look, face, light, tone);
        }
        Material::Thing(thing) if material.is_bent() => {
            points(level, shared, blocks, stage, &setting.view);
            swell(level, blocks, thing, setting.view.position);
            simple::crown(level, blocks, thing.colour());
            lighting::develop_bent(level, shared, blocks, light, tone);
        }
        Material::Ground(label) => simple::even(level, shared, blocks, simple::ground_colour(*label), tone),
        Material::Roof(roof) => simple::even(level, shared, blocks, roof.colour(), tone),
        Material::Tiles(slope) => simple::even(level, shared, blocks, slope.colour(), tone),
        Material::Thing(thing) => simple::even(level, shared, blocks, thing.colour(), tone),
        Material::Cloth(look) => simple::even(level, shared, blocks, look.colour, tone),
        Material::Coach(look) => simple::even(level, shared, blocks, look.colour, tone),
        Material::Skin(look) => simple::even(level, shared, blocks, look.even, tone),
        Material::Sky => {}
    }
}

fn group_of(faces: &[DrawnFace], face: u32) -> usize {
    if face == NO_FACE {
        return SKY;
    }
    let drawn = &faces[face as usize];
    match drawn.source {
        FaceSource::Ground { .. } => usize::from(drawn.label).min(SKY - 1),
        FaceSource::Figure { first_face, .. } => SHARED_GROUPS + first_face as usize,
        FaceSource::Box { .. } | FaceSource::Prop { .. } => SHARED_GROUPS + face as usize,
    }
}

simd_kernel! {
    /// Less sky where something stands on the ground: around `feet`, `radius_m` wide.
    fn contact(shared: &mut [Shared], feet: Vec3, radius_m: f32) {
        let per_radius2 = 1.0 / (radius_m * radius_m);
        for shared in shared.iter_mut() {
            for k in 0..WIDE {
                let away = get(&shared.middle, k) - feet;
                let shade = share(1.0 - away.dot(away) * per_radius2 * (1.0 / 9.0));
                let kept = 1.0 - 0.55 * shade * shade * shade;
                shared.sky[k] *= kept;
                shared.lamps[k] *= kept;
            }
        }
    }
}

simd_kernel! {
    /// Less sky below and beside a vehicle: a rectangle around `feet` whose length lies along `along`.
    fn contact_below(shared: &mut [Shared], feet: Vec3, along: [f32; 2], half_m: [f32; 2]) {
        let ([cos, sin], [half_length_m, half_width_m]) = (along, half_m);
        for shared in shared.iter_mut() {
            for k in 0..WIDE {
                let away = get(&shared.middle, k) - feet;
                let (ahead, aside) = (away.x * cos + away.y * sin, away.y * cos - away.x * sin);
                let (ahead, aside) = (most(ahead.abs() - half_length_m, 0.0), most(aside.abs() - half_width_m, 0.0));
                let shade = share(1.0 - (ahead * ahead + aside * aside + away.z * away.z) * 1.6);
                let kept = 1.0 - 0.75 * shade * shade * shade;
                shared.sky[k] *= kept;
                shared.lamps[k] *= kept;
            }
        }
    }
}
