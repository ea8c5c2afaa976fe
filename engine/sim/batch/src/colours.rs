//! Colours, by the large renderer's own shading of the faces that were found here.

use crate::canvas::{Canvas, WIDE};
use crate::faces::{BODY, DrawnFace};
use crate::outputs::Outputs;
use crate::view::BatchView;
use cosfly_domain::{Camera, TARGET_INSTANCE, Weather};
use cosfly_frames::simd::Level;
use cosfly_raster::visibility::NO_FACE;
use cosfly_render::{BodyPart, FoundFace, FoundPicture, FoundSource, FrameParts, FrameSetup, Renderer, Scene};

/// The shading of one painter; its buffers are there once somebody asks for colours.
#[derive(Default)]
pub struct Colours {
    drawing: Drawing,
    /// The picture's faces that are seen, and which of them is nearest at each pixel.
    faces: Vec<FoundFace>,
    nearest: Vec<u32>,
    inverse_depth: Vec<f32>,
    /// Numbers of all faces among those that are seen; [`NO_FACE`] for others.
    numbers: Vec<u32>,
}

impl Colours {
    /// Shades a picture whose town and bodies are drawn.
    ///
    /// # Panics
    /// Where the scene of the view was made without colours.
    pub fn draw(
        &mut self,
        level: Level,
        view: &BatchView<'_>,
        canvas: &Canvas,
        (faces, parts): (&[DrawnFace], &[BodyPart]),
        rgb: &mut [u8],
    ) {
        self.find(canvas, faces);
        let Self { drawing, faces, nearest, inverse_depth, .. } = self;
        let picture = FoundPicture { nearest, inverse_depth, faces, parts };
        drawing.with(level, view, [canvas.width, canvas.height], &mut |renderer, scene, setup| {
            rgb.copy_from_slice(renderer.colours_of(scene, setup, &picture));
        });
    }

    /// Draws a picture of a scan, all of it.
    pub fn draw_scan(&mut self, level: Level, view: &BatchView<'_>, size: [usize; 2], outputs: &mut Outputs<'_>) {
        let parts = if outputs.rgb.is_some() { FrameParts::All } else { FrameParts::Ids };
        self.drawing.with(level, view, size, &mut |renderer, scene, setup| {
            let images = renderer.render_parts(scene, setup, parts).images;
            copy(&mut outputs.rgb, &images.rgb);
            copy(&mut outputs.depth_m, &images.depth_m);
            copy(&mut outputs.semantic, &images.semantic);
            copy(&mut outputs.instance, &images.instance);
            if let Some(mask) = &mut outputs.target_mask {
                let is_target = images.instance.iter().map(|id| u8::from(*id == TARGET_INSTANCE));
                mask.iter_mut().zip(is_target).for_each(|(to, from)| *to = from);
            }
            if !outputs.on_request.is_empty() {
                renderer.for_each_point(&view.pose, &mut |at, point| {
                    outputs.on_request.iter_mut().for_each(|channel| channel.set(at, point));
                });
            }
        });
    }

    /// Lists the faces that are seen, in the order of the pixels.
    fn find(&mut self, canvas: &Canvas, faces: &[DrawnFace]) {
        let Self { faces: seen, nearest, inverse_depth, numbers, .. } = self;
        seen.clear();
        nearest.clear();
        inverse_depth.clear();
        numbers.clear();
        numbers.resize(faces.len(), NO_FACE);
        let blocks = canvas.blocks.max(1);
        for (row, depths) in canvas.face.chunks_exact(blocks).zip(canvas.inverse_depth.chunks_exact(blocks)) {
            inverse_depth.extend_from_slice(&depths.as_flattened()[..canvas.width]);
            let start = nearest.len();
            let (mut last, mut number) = (0.0, NO_FACE);
            for block in row {
                let mut found = [number; WIDE];
                if block.iter().any(|face| *face != last) {
                    for (face, found) in block.iter().zip(&mut found) {
                        if *face != last {
                            last = *face;
                            number = number_of(last as i32 as usize, faces, numbers, seen);
                        }
                        *found = number;
                    }
                }
                nearest.extend_from_slice(&found);
            }
            nearest.truncate(start + canvas.width);
        }
    }
}

/// The number of a face among those that are seen: the next one, where the face is seen for the first time.
fn number_of(face: usize, faces: &[DrawnFace], numbers: &mut [u32], seen: &mut Vec<FoundFace>) -> u32 {
    let (Some(drawn), Some(number)) = (faces.get(face), numbers.get_mut(face)) else { return NO_FACE };
    if *number == NO_FACE && drawn.number != NO_FACE {
        *number = seen.len() as u32;
        let of = match drawn.number {
            part if part >= BODY => FoundSource::Body(part - BODY),
            number => FoundSource::Town(number),
        };
        let DrawnFace { plane, triangle, label, instance, .. } = *drawn;
        seen.push(FoundFace { plane, of, triangle, label, instance });
    }
    *number
}

fn copy<T: Copy>(to: &mut Option<&mut [T]>, from: &[T]) {
    if let Some(to) = to {
        to.copy_from_slice(from);
    }
}

/// The large renderer for pictures of one size.
#[derive(Default)]
struct Drawing {
    renderer: Option<Renderer>,
    noon: Option<Weather>,
}

impl Drawing {
    /// Calls `draw` with the renderer, the scene and the setup of a view.
    ///
    /// # Panics
    /// Where the scene of the view was made without colours.
    fn with(
        &mut self,
        level: Level,
        view: &BatchView<'_>,
        [width, height]: [usize; 2],
        draw: &mut dyn FnMut(&mut Renderer, &Scene, &FrameSetup<'_>),
    ) {
        let Some(scene) = &view.scene.large else {
            panic!("colours are asked for of a scene that was prepared without them");
        };
        let Self { renderer, noon } = self;
        let (width, height) = (width as u32, height as u32);
        let camera = Camera { width, height, horizontal_fov_rad: view.horizontal_fov_rad };
        let renderer = match renderer {
            Some(known) if known.camera() == camera => known,
            other => other.insert(new_renderer(camera)),
        };
        renderer.set_level(level);
        renderer.set_look(view.look);
        let weather = view.weather.unwrap_or_else(|| &*noon.get_or_insert_with(cosfly_materials::presets::clear_noon));
        draw(renderer, scene, &FrameSetup { pose: view.pose, weather, target: view.target, others: view.others });
    }
}

fn new_renderer(camera: Camera) -> Renderer {
    let mut renderer = Renderer::new(camera);
    renderer.set_parallel(false);
    renderer
}
