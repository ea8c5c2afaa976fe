//! Colours, by the large renderer's own shading of the faces that were found here.

use crate::canvas::{Canvas, WIDE};
use crate::faces::{BODY, DrawnFace};
use crate::view::BatchView;
use cosfly_domain::{Camera, Weather};
use cosfly_frames::simd::Level;
use cosfly_raster::visibility::NO_FACE;
use cosfly_render::{BodyPart, FoundFace, FoundPicture, FoundSource, FrameSetup, Renderer};

/// Weather of views without any.
const WEATHER: &str = "ClearNoon";

/// The shading of one painter; its buffers are there once somebody asks for colours.
#[derive(Default)]
pub struct Colours {
    renderer: Option<Renderer>,
    noon: Option<Weather>,
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
        let Some(scene) = &view.scene.large else {
            panic!("colours are asked for of a scene that was prepared without them");
        };
        self.find(canvas, faces);
        let Self { renderer, noon, faces, nearest, inverse_depth, .. } = self;
        let (width, height) = (canvas.width as u32, canvas.height as u32);
        let camera = Camera { width, height, horizontal_fov_rad: view.horizontal_fov_rad };
        let renderer = match renderer {
            Some(known) if known.camera() == camera => known,
            other => other.insert(new_renderer(camera)),
        };
        renderer.set_level(level);
        renderer.set_look(view.look);
        if noon.is_none() {
            *noon = cosfly_materials::presets::preset(WEATHER);
        }
        let Some(weather) = view.weather.or(noon.as_ref()) else { return };
        let target = view.target;
        let setup = FrameSetup { pose: view.pose, weather, target, others: view.others };
        let picture = FoundPicture { nearest, inverse_depth, faces, parts };
        rgb.copy_from_slice(renderer.colours_of(scene, &setup, &picture));
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

fn new_renderer(camera: Camera) -> Renderer {
    let mut renderer = Renderer::new(camera);
    renderer.set_parallel(false);
    renderer
}
