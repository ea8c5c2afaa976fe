//! Optical flow: where the points that a frame shows are in a frame beside it, and whether that one shows them.
//!
//! Between two moments every surface moves by an affine map: the town by the camera's own motion, a vehicle with its box, people
//! part by part with the triangles of their figures. The map from this camera's axes to the other one's takes the ray through a
//! pixel centre, with its inverse depth, to the other picture. The sky is what has the inverse depth 0.

use super::Renderer;
use crate::faces::FaceSource;
use crate::people::Person;
use crate::setup::FrameSetup;
use cosfly_domain::channels::{ChannelSource, FlowTo};
use cosfly_domain::{Camera, Lens, TARGET_INSTANCE};
use cosfly_figures::{FigureInPicture, FigureTriangle, add_figure};
use cosfly_frames::{DMat3, DVec3, real};
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{NEAR_M, NO_FACE, PlaneOnScreen, Screen};
use std::cell::OnceCell;
use std::ops::Range;

/// A surface hides a point that is farther by more than this, metres and a share of its depth.
const HIDES_M: f64 = 0.03;
const HIDES_SHARE: f64 = 0.002;
/// Most strips of a rolling shutter that are tried for the moment at which a point is seen.
const MOST_TRIES: usize = 8;

/// A frame beside the one that is drawn: what is nearest at each pixel, and who is where when its rows are taken.
#[derive(Default)]
pub(crate) struct OtherFrame {
    strips: Vec<OtherStrip>,
    /// Planes of the faces that are nearest somewhere, strip by strip.
    planes: Vec<PlaneOnScreen>,
    /// Number of the plane that is nearest at each pixel of the ideal picture.
    nearest: Vec<u32>,
}

/// Rows of the other frame that share a moment.
struct OtherStrip {
    rows: Range<usize>,
    eye: Eye,
    bodies: Vec<FigureInPicture>,
}

/// The finished picture and its lens.
#[derive(Clone, Copy)]
pub(crate) struct SeenThrough {
    pub camera: Camera,
    pub lens: Lens,
}

/// Motion of a surface to a moment of the other frame: from this camera's axes to the other one's.
#[derive(Clone, Copy)]
struct Motion {
    turn: DMat3,
    shift_m: DVec3,
}

/// Pixel coordinates in the ideal picture, and depth in metres.
struct Place {
    u: f64,
    v: f64,
    depth_m: f64,
}

impl OtherFrame {
    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.strips.clear();
        self.planes.clear();
        self.nearest.clear();
    }

    fn is_none(&self) -> bool {
        self.strips.is_empty()
    }

    /// The strip that takes a row of the ideal picture; the nearest one beyond its ends.
    fn strip_at(&self, v: f64) -> usize {
        let behind = self.strips.partition_point(|strip| strip.rows.end as f64 <= v);
        behind.min(self.strips.len().saturating_sub(1))
    }

    /// Whether the pixel that holds a place shows nothing that hides the point there. A surface hides it where it is nearer at the place
    /// itself and at the pixel's centre: at the edge of two faces the plane of one goes on before the other.
    fn shows(&self, screen: &Screen, place: &Place) -> bool {
        let (column, row) = (place.u.floor(), place.v.floor());
        if column < 0.0 || row < 0.0 || column >= screen.width as f64 || row >= screen.height as f64 {
            return false;
        }
        let face = self.nearest.get(row as usize * screen.width + column as usize);
        let Some(plane) = face.and_then(|face| self.planes.get(*face as usize)) else { return true };
        let hides = |inverse: f64| inverse > 0.0 && (1.0 / inverse) * (1.0 + HIDES_SHARE) + HIDES_M < place.depth_m;
        !(hides(plane.at(place.u, place.v)) && hides(plane.at(column + 0.5, row + 0.5)))
    }
}

impl Renderer {
    /// Takes rows of the frame that was drawn last, at the moment of `setup`, into a frame beside another one.
    pub(crate) fn remember(&self, setup: &FrameSetup<'_>, rows: Range<usize>, other: &mut OtherFrame) {
        let mut numbers = vec![NO_FACE; self.faces.len()];
        for face in &self.nearest.face[rows.start * self.screen.width..rows.end * self.screen.width] {
            let Some(number) = numbers.get_mut(*face as usize) else {
                other.nearest.push(NO_FACE);
                continue;
            };
            if *number == NO_FACE {
                *number = other.planes.len() as u32;
                other.planes.push(self.faces[*face as usize].plane);
            }
            other.nearest.push(*number);
        }
        let target = setup.target.map(|figure| FigureInPicture { figure, instance: TARGET_INSTANCE });
        let bodies = target.into_iter().chain(setup.others.iter().copied()).collect();
        other.strips.push(OtherStrip { rows, eye: Eye::new(&setup.pose), bodies });
    }

    /// Whether films have to draw channels of frames beside this one.
    pub(crate) fn has_flow(&self, to: FlowTo) -> bool {
        self.images.on_request.iter().any(|image| flow_of(image.channel.source) == Some(to))
    }

    /// Draws the flow of rows of the frame that was drawn last, from `setup`, to a frame beside it.
    pub(crate) fn draw_flow(
        &mut self,
        setup: &FrameSetup<'_>,
        rows: Range<usize>,
        (to, other): (FlowTo, &OtherFrame),
        seen_through: &SeenThrough,
    ) {
        let width = self.screen.width;
        let drawn: Vec<([f32; 2], bool)> = if other.is_none() {
            vec![([0.0; 2], false); width * rows.len()]
        } else {
            let flow = Flow::new(self, Eye::new(&setup.pose), other, seen_through);
            rows.clone().flat_map(|row| flow.row(row)).collect()
        };
        for image in &mut self.images.on_request {
            let size = image.channel.bytes_on_request();
            let pixels = &mut image.bytes[size * width * rows.start..size * width * rows.end];
            match image.channel.source {
                ChannelSource::Flow(own) if own == to => {
                    let (pixels, _) = pixels.as_chunks_mut::<8>();
                    for (pixel, ([right, down], _)) in pixels.iter_mut().zip(&drawn) {
                        pixel[..4].copy_from_slice(&right.to_le_bytes());
                        pixel[4..].copy_from_slice(&down.to_le_bytes());
                    }
                }
                ChannelSource::FlowValid(own) if own == to => {
                    pixels.iter_mut().zip(&drawn).for_each(|(pixel, (_, is_seen))| *pixel = u8::from(*is_seen));
                }
                _ => {}
            }
        }
    }
}

/// The neighbour that a channel looks at.
fn flow_of(source: ChannelSource) -> Option<FlowTo> {
    match source {
        ChannelSource::Flow(to) | ChannelSource::FlowValid(to) => Some(to),
        _ => None,
    }
}

/// The flow from one frame to another one.
struct Flow<'a> {
    renderer: &'a Renderer,
    other: &'a OtherFrame,
    seen_through: &'a SeenThrough,
    /// Columns and rows of the ideal picture before the finished one.
    margin_px: [f64; 2],
    /// Motion of what stands, to the moment of each strip.
    town: Vec<Motion>,
    eye: Eye,
    /// Of each strip that a point may be in: everybody in this frame, where they are there.
    bodies: Vec<OnceCell<Vec<Option<OtherBody>>>>,
}

/// Somebody in the other frame.
struct OtherBody {
    /// With the vehicle.
    rigid: Motion,
    /// The figure, of people and of riders.
    figure: Vec<FigureTriangle>,
}

impl<'a> Flow<'a> {
    fn new(renderer: &'a Renderer, eye: Eye, other: &'a OtherFrame, seen_through: &'a SeenThrough) -> Self {
        let Camera { width, height, .. } = seen_through.camera;
        let (ideal, finished) = (&renderer.screen, [f64::from(width), f64::from(height)]);
        let margin_px = [0.5 * (ideal.width as f64 - finished[0]), 0.5 * (ideal.height as f64 - finished[1])];
        let town = other.strips.iter().map(|strip| Motion::in_world(&eye, &strip.eye, DMat3::IDENTITY, DVec3::ZERO));
        let bodies = other.strips.iter().map(|_| OnceCell::new()).collect();
        Self { renderer, other, seen_through, margin_px, town: town.collect(), eye, bodies }
    }

    /// Flow and mask of the pixels of a row.
    fn row(&self, row: usize) -> impl Iterator<Item = ([f32; 2], bool)> + use<'_, 'a> {
        let screen = &self.renderer.screen;
        let v = row as f64 + 0.5;
        let up = (screen.center_v - v) / screen.focal_px;
        // Neighbouring pixels are mostly of one face.
        let mut last = (NO_FACE - 1, usize::MAX, None);
        (0..screen.width).map(move |column| {
            let u = column as f64 + 0.5;
            let face = self.renderer.nearest.face[row * screen.width + column];
            let drawn = self.renderer.faces.get(face as usize);
            let inverse = drawn.map_or(0.0, |drawn| drawn.plane.at(u, v));
            let ray = DVec3::new(1.0, (u - screen.center_u) / screen.focal_px, up);
            let mut motion = |strip: usize| {
                if (last.0, last.1) != (face, strip) {
                    last = (face, strip, self.motion(drawn.map(|drawn| drawn.source), strip));
                }
                last.2
            };
            let mut strip = self.other.strip_at(v);
            let (mut place, mut is_taken) = (None, false);
            for _ in 0..MOST_TRIES {
                place = motion(strip).and_then(|motion: Motion| motion.place(screen, ray, inverse));
                let taken = place.as_ref().map_or(strip, |place: &Place| self.other.strip_at(place.v));
                is_taken = taken == strip;
                if is_taken {
                    break;
                }
                strip = taken;
            }
            let Some(place) = place else { return ([0.0; 2], false) };
            let (from, to) = (self.finished(u, v), self.finished(place.u, place.v));
            let Camera { width, height, .. } = self.seen_through.camera;
            let is_inside = (0.0..f64::from(width)).contains(&to.0) && (0.0..f64::from(height)).contains(&to.1);
            let is_seen = is_inside && is_taken && self.other.shows(screen, &place);
            ([(to.0 - from.0) as f32, (to.1 - from.1) as f32], is_seen)
        })
    }

    /// From the ideal picture to the finished one.
    fn finished(&self, u: f64, v: f64) -> (f64, f64) {
        let SeenThrough { camera, lens } = self.seen_through;
        lens.bend(camera, (u - self.margin_px[0], v - self.margin_px[1]))
    }

    /// Everybody in this frame, where they are at the moment of a strip.
    fn bodies_at(&self, strip: usize) -> &[Option<OtherBody>] {
        let members = self.renderer.people.members.iter();
        let there = &self.other.strips[strip];
        self.bodies[strip].get_or_init(|| members.map(|person| OtherBody::of(person, &self.eye, there)).collect())
    }

    /// Motion of a face to the moment of a strip; none for somebody who is not there then.
    fn motion(&self, source: Option<FaceSource>, strip: usize) -> Option<Motion> {
        let Some(FaceSource::Figure { look, triangle, is_cloth, .. }) = source else { return Some(self.town[strip]) };
        let people = &self.renderer.people;
        let number = people.looks[look as usize].person as usize;
        let person = &people.members[number];
        if person.town_label.is_some() {
            return Some(self.town[strip]);
        }
        let there = self.bodies_at(strip)[number].as_ref()?;
        if !is_cloth {
            return Some(there.rigid);
        }
        let here = &people.triangles[person.triangles.clone()];
        let (from, to) = (here.get(triangle as usize)?, there.figure.get(triangle as usize)?);
        // A part that has become flat in one of two frames has fewer triangles.
        (here.len() == there.figure.len()).then(|| of_triangle(from, to, &self.eye, &self.other.strips[strip].eye))
    }
}

impl OtherBody {
    fn of(person: &Person, eye: &Eye, strip: &OtherStrip) -> Option<Self> {
        if person.town_label.is_some() || !person.is_seen {
            return None;
        }
        let there = strip.bodies.iter().find(|body| body.instance == person.instance)?.figure;
        let here = &person.figure;
        let mut triangles = vec![];
        add_figure(&there, &person.clothes, 0, &mut triangles);
        let turn = turn_about_up(there.state.heading_rad - here.state.heading_rad);
        let shift_m = there.state.feet_in_world - turn * here.state.feet_in_world;
        there.has_body().then(|| Self { rigid: Motion::in_world(eye, &strip.eye, turn, shift_m), figure: triangles })
    }
}

/// A turn to the right around the vertical.
fn turn_about_up(angle_rad: f64) -> DMat3 {
    let (sin, cos) = real::sin_cos(angle_rad);
    DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
}

/// Motion of the plane of a triangle: its points keep their place among the corners.
fn of_triangle(from: &FigureTriangle, to: &FigureTriangle, eye: &Eye, other: &Eye) -> Motion {
    let [a, b, c] = from.corners_in_world;
    let (along, aside) = (b - a, c - a);
    let normal = along.cross(aside);
    let [dual_along, dual_aside] = [aside.cross(normal), normal.cross(along)].map(|it| it / normal.length_squared());
    let [a_there, b_there, c_there] = to.corners_in_world;
    let outer = |to: DVec3, of: DVec3| DMat3::from_cols(to * of.x, to * of.y, to * of.z);
    let turn = outer(b_there - a_there, dual_along) + outer(c_there - a_there, dual_aside);
    Motion::in_world(eye, other, turn, a_there - turn * a)
}

impl Motion {
    /// A motion `turn * point + shift_m` in the world, seen from two eyes.
    fn in_world(from: &Eye, to: &Eye, turn: DMat3, shift_m: DVec3) -> Self {
        let body_from_world = to.world_from_body.transpose();
        Self {
            turn: body_from_world * turn * from.world_from_body,
            shift_m: to.see(turn * from.position_in_world + shift_m),
        }
    }

    /// Place of the point along a ray, whose length along the optical axis is 1, at an inverse depth; none behind the camera.
    fn place(&self, screen: &Screen, ray: DVec3, inverse: f64) -> Option<Place> {
        let seen = self.turn * ray + self.shift_m * inverse;
        let depth_m = seen.x / inverse;
        (seen.x > 1e-6 && depth_m > NEAR_M).then(|| Place {
            u: screen.center_u + screen.focal_px * seen.y / seen.x,
            v: screen.center_v - screen.focal_px * seen.z / seen.x,
            depth_m,
        })
    }
}
