//! Bands of rows: pixels gathered by face, taken through the kernels, put back.

use super::cloth::{Cloth, Cloths, put_cloth};
use super::curve::Curve;
use super::face_material::{axes_of, even_colour, material_of};
use super::foliage::{self, crown_of};
use super::geometry::FaceAxes;
use super::kernels::{Staged, run_kernels, run_simple_kernels};
use super::material::{FLAT, Material, UNDER_A_SCAN};
use super::setting::{Seen, Setting};
use super::simple::put_colour;
use crate::faces::FaceSource;
use crate::look::PictureLook;
use crate::passes::ids::{Band, Run};
use cosfly_domain::SemanticLabel;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_materials::kerbs::{KerbLine, Kerbs, put_kerb};
use cosfly_materials::lanes::{
    Block, EMPTY_ROW, FOUR, FOURS, GROUPS, LANES, PendingFours, Shared, StageRow, WIDE, write_row, write_three,
};
use cosfly_materials::leaves::{Crowns, put_crown};
use cosfly_materials::vector::Vec3;
use cosfly_raster::visibility::{NO_FACE, PlaneOnScreen};

/// Groups of pixels that are not of a single face: the sky, people, crowns, and ground by label. Faces of one part of a vehicle are a
/// group, too, named after the first of them.
const SKY: usize = 63;
const PEOPLE: usize = 62;
const CROWNS: usize = 61;
/// Even surfaces of the simple look that are not ground.
const EVEN: usize = 60;
/// A mesh that the weather lights.
const SCAN: usize = 59;
const SHARED_GROUPS: usize = 64;
const PAVEMENT: usize = SemanticLabel::SideWalks.id() as usize;
/// No run follows.
const END: u32 = u32::MAX;

/// Buffers of one thread that shades bands.
pub(crate) struct Worker {
    stage: Box<PendingFours>,
    cloths: Box<Cloths>,
    crowns: Box<Crowns>,
    kerbs: Box<Kerbs>,
    colours: Box<[StageRow; 3]>,
    /// What a lit mesh reflects at each pixel of the stage.
    albedo: Box<[[f32; 3]; LANES]>,
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
    /// Pieces of faces that are not flat to light.
    curves: Vec<(usize, Curve)>,
    /// Numbers of the people who may darken something in the band, with the pixels where they may; and of those among the pieces.
    near_band: Vec<(u32, [i32; 4])>,
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
    axes: FaceAxes,
}

/// Rows and columns of pieces: first ones, and ones past the last.
struct Spans {
    row: [i32; FOURS],
    first: [i32; FOURS],
    end: [i32; FOURS],
}

simd_kernel! {
    /// Whether any piece has a pixel in a part of the screen: first column and row, and the ones past the last.
    fn meets_any(spans: &Spans, reach: [i32; 4]) -> bool {
        let [left, top, right, bottom] = reach;
        let mut any = 0u32;
        for k in 0..FOURS {
            let inside = (spans.row[k] >= top) & (spans.row[k] < bottom) & (spans.first[k] < right) & (spans.end[k] > left);
            any |= u32::from(inside);
        }
        any != 0
    }
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
            stage: Box::new(PendingFours::EMPTY),
            cloths: Box::new(Cloths::EMPTY),
            crowns: Box::new(Crowns::EMPTY),
            kerbs: Box::new(Kerbs::EMPTY),
            colours: Box::new([EMPTY_ROW; 3]),
            albedo: Box::new([[0.0; 3]; LANES]),
            shared: Box::new([Shared::EMPTY; GROUPS]),
            blocks: Box::new([Block::EMPTY; FOUR * GROUPS]),
            developed: Box::new([0; LANES + WIDE]),
            picture: Vec::new(),
            runs: Vec::new(),
            first: Vec::new(),
            present: Vec::new(),
            pieces: Vec::with_capacity(FOURS),
            curves: Vec::new(),
            near_band: Vec::new(),
            near: Vec::new(),
        }
    }

    /// Shades a band from its runs.
    pub fn shade(&mut self, setting: &Setting, seen: &Seen<'_>, band: &mut Band<'_>) {
        self.picture.resize(band.rgb.len() / 3, 0);
        self.gather(setting, seen, band);
        let rows = band.first_row..band.first_row + self.picture.len() / band.width.max(1);
        let people = (0u32..).zip(&seen.people.members);
        self.near_band.clear();
        let near = people.filter(|(_, person)| person.reach.meets_rows(rows.clone()));
        self.near_band.extend(near.map(|(k, person)| (k, person.reach.pixels())));
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
    fn gather(&mut self, setting: &Setting, seen: &Seen<'_>, band: &mut Band<'_>) {
        let groups = SHARED_GROUPS + seen.faces.len();
        if self.first.len() < groups {
            self.first.resize(groups, END);
        }
        let mut last_group = usize::MAX;
        let mut crowns = core::mem::take(&mut band.runs.crowns);
        for run in &band.runs.all {
            let group = group_of(setting, seen, run.face);
            if group == CROWNS {
                foliage::note(seen, run, band.width, &mut crowns);
            }
            if group == last_group
                && group < SCAN
                && let Some(last) = self.runs.last_mut()
                && !(run.start as usize).is_multiple_of(band.width)
                && are_one_plane(seen, band, &last.run, run)
                && (group != PAVEMENT || kerb_of(seen, last.run.face) == kerb_of(seen, run.face))
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
        band.runs.crowns = crowns;
    }

    fn shade_group(&mut self, setting: &Setting, seen: &Seen<'_>, band: &Band<'_>, group: usize) {
        let mut next = self.first[group];
        let first = self.runs[next as usize].run;
        let (material, mut axes) =
            if group == EVEN { (Material::Even, FLAT) } else { material_of(setting, seen, first.face) };
        let mut lanes = 0;
        while next != END {
            let Link { run, next: after } = self.runs[next as usize];
            next = after;
            let (on_screen, normal) = plane_of(seen, run.face);
            let (mut start, end) = (run.start as usize, (run.start + run.length) as usize);
            let look = if group == PEOPLE { cloth_of(seen, run.face) } else { None };
            let colour = (group == EVEN).then(|| even_colour(seen, run.face));
            let crown = if group == CROWNS { crown_of(seen, run.face) } else { None };
            let kerb = if group == PAVEMENT { Some(kerb_of(seen, run.face)) } else { None };
            let curve = if let Material::Coach(_) = material { Curve::of(seen, run.face) } else { None };
            if crown.is_some() {
                axes = axes_of(seen, run.face);
            }
            while start < end {
                let length = (end - start).min(LANES - lanes);
                let (u, v) = center_of(band, start);
                self.curves.extend(curve.map(|curve| (self.pieces.len(), curve)));
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
                    axes,
                });
                if let Some(look) = &look {
                    put_cloth(setting.level, &mut self.cloths, lanes / FOUR, length.div_ceil(FOUR), look);
                }
                if let Some(colour) = colour {
                    put_colour(setting.level, &mut self.colours, lanes / FOUR, length.div_ceil(FOUR), colour);
                }
                if let Some(look) = crown {
                    put_crown(setting.level, &mut self.crowns, lanes / FOUR, length.div_ceil(FOUR), look);
                }
                if let Some(line) = &kerb {
                    put_kerb(setting.level, &mut self.kerbs, lanes / FOUR, length.div_ceil(FOUR), line);
                }
                if let (SCAN, Some(mesh)) = (group, seen.scene.lit_mesh()) {
                    let pixels = seen.albedo[band.first_row * band.width + start..].iter().take(length);
                    let albedo = pixels.zip(&mut self.albedo[lanes..]);
                    albedo.for_each(|(colour, albedo)| *albedo = colour.map(|share| mesh.exposure * share));
                }
                lanes += length.next_multiple_of(FOUR);
                start += length;
                if lanes == LANES {
                    self.flush(setting, seen, &material, lanes);
                    lanes = 0;
                }
            }
        }
        if lanes > 0 {
            self.flush(setting, seen, &material, lanes);
        }
    }

    /// Lists who may darken a pixel of the pieces.
    fn find_near(&mut self, level: Level) {
        self.near.clear();
        if self.near_band.is_empty() {
            return;
        }
        let mut spans = Spans { row: [i32::MAX; FOURS], first: [0; FOURS], end: [0; FOURS] };
        let (mut first, mut end) = ([i32::MAX; 2], [i32::MIN; 2]);
        for (at, piece) in self.pieces.iter().enumerate().take(FOURS) {
            let (row, column) = (piece.v as i32, piece.u as i32);
            let next = column + piece.length as i32;
            (spans.row[at], spans.first[at], spans.end[at]) = (row, column, next);
            first = [first[0].min(column), first[1].min(row)];
            end = [end[0].max(next), end[1].max(row + 1)];
        }
        let near = self.near_band.iter().filter(|(_, reach)| {
            let [left, top, right, bottom] = *reach;
            // Most are told by all pieces at once.
            let meets_all = left < end[0] && right > first[0] && top < end[1] && bottom > first[1];
            meets_all && meets_any(level, &spans, *reach)
        });
        self.near.extend(near.map(|(person, _)| *person));
    }

    /// Takes the filled lanes through the kernels and writes their pixels.
    fn flush(&mut self, setting: &Setting, seen: &Seen<'_>, material: &Material, lanes: usize) {
        let groups = lanes.div_ceil(FOUR * WIDE);
        self.find_near(setting.level);
        fill(setting.level, &self.pieces, &mut self.stage);
        for (number, curve) in &self.curves {
            let piece = &self.pieces[*number];
            curve.bend(&setting.view, &mut self.stage, piece.lane / FOUR, piece.length.div_ceil(FOUR));
        }
        let Self { stage, cloths, crowns, kerbs, colours, albedo, shared, blocks, near, .. } = &mut *self;
        let staged = Staged { stage, cloths, crowns, kerbs, colours, albedo };
        let blocks = (&mut shared[..groups], &mut blocks[..FOUR * groups]);
        match setting.look {
            PictureLook::Full => run_kernels(setting, seen, material, staged, blocks, near),
            PictureLook::Simple => run_simple_kernels(setting, material, staged, blocks),
        }
        put_back(setting.level, &self.pieces, &self.blocks[..FOUR * groups], &mut self.developed, &mut self.picture);
        self.pieces.clear();
        self.curves.clear();
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
    fn fill(pieces: &[Piece], stage: &mut PendingFours) {
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
                for (row, values) in [(&mut stage.u, u), (&mut stage.inverse, inverses)] {
                    row[fours.clone()].copy_from_slice(&values);
                }
                for (row, value) in
                    [(&mut stage.v, piece.v), (&mut stage.across, piece.across), (&mut stage.down, piece.down)]
                {
                    write_row(row, fours.start, value);
                }
                let [x, y, z] = piece.normal;
                write_three(&mut stage.normal, fours.start, Vec3::new(x, y, z));
                write_three(&mut stage.along, fours.start, piece.axes.along);
                write_three(&mut stage.up, fours.start, piece.axes.up);
            }
        }
    }
}

/// Bits of those lanes that are taken, and of the others: slices of it are read, since a comparison would become masked
/// stores, which are slow on many processors.
const TAKEN: [u32; 2 * WIDE] = {
    let mut taken = [0; 2 * WIDE];
    let mut k = 0;
    while k < WIDE {
        taken[k] = u32::MAX;
        k += 1;
    }
    taken
};

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
                        let taken: &[u32; WIDE] = TAKEN[WIDE - left..].first_chunk().unwrap_or(&[0; WIDE]);
                        for k in 0..WIDE {
                            out[k] = old[k] ^ ((old[k] ^ lanes[k]) & taken[k]);
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

fn group_of(setting: &Setting, seen: &Seen<'_>, face: u32) -> usize {
    if face == NO_FACE {
        return SKY;
    }
    let drawn = &seen.faces[face as usize];
    let is_simple = setting.look == PictureLook::Simple;
    match drawn.source {
        FaceSource::Ground { .. } => usize::from(drawn.label).min(SCAN - 1),
        FaceSource::Mesh { .. } if seen.scene.lit_mesh().is_some() => SCAN,
        FaceSource::Mesh { .. } | FaceSource::Splats => usize::from(UNDER_A_SCAN.id()),
        FaceSource::Figure { .. } if is_simple => EVEN,
        FaceSource::Figure { is_cloth: true, .. } => PEOPLE,
        FaceSource::Figure { first_face, .. } => SHARED_GROUPS + first_face as usize,
        FaceSource::Crown { .. } => CROWNS,
        FaceSource::Box { index, face } if is_simple && !seen.scene.is_wall(index, face) => EVEN,
        FaceSource::Box { .. } | FaceSource::Prop { .. } => SHARED_GROUPS + face as usize,
    }
}

/// The kerb beside a face of ground.
fn kerb_of(seen: &Seen<'_>, face: u32) -> KerbLine {
    match seen.faces.get(face as usize).map(|face| face.source) {
        Some(FaceSource::Ground { cluster, polygon }) => {
            seen.scene.clusters[cluster as usize].polygons[usize::from(polygon)].kerb
        }
        _ => KerbLine::NONE,
    }
}

/// The look of a part of a person that a face belongs to.
fn cloth_of(seen: &Seen<'_>, face: u32) -> Option<Cloth> {
    let FaceSource::Figure { look, .. } = seen.faces.get(face as usize)?.source else { return None };
    let look = seen.people.looks.get(look as usize)?;
    Some(Cloth::new(seen.people.members.get(look.person as usize)?, look))
}
