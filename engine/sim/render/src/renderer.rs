//! One frame from start to end: cull, draw, resolve, shade, measure the target.

mod colours;
pub(crate) mod flow;
mod ground;
mod mesh;
mod splats;

use crate::faces::{DrawnFace, FaceSource, box_lift};
use crate::frame::RenderedFrame;
use crate::look::PictureLook;
use crate::passes::ids::{SeenRuns, for_each_band};
use crate::passes::on_request;
use crate::people::{PartLook, People};
use crate::scene::Scene;
use crate::scene_splats::Composer;
use crate::setup::FrameSetup;
use crate::shade::setting::Seen;
use crate::shade::shader::Shader;
use crate::shade::smooth;
use crate::stages::{Stages, Stopwatch};
use crate::target_view;
use cosfly_domain::channels::SeenPoint;
use cosfly_domain::{
    BodyView, Camera, ChannelImage, ChannelSet, FrameImages, Optics, SemanticLabel, TARGET_INSTANCE, TargetView,
};
use cosfly_figures::Region;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose};
use cosfly_materials::far_light::FarLight;
use cosfly_materials::parts::BOX_FACES;
use cosfly_optics::Glass;
use cosfly_raster::eye::Eye;
use cosfly_raster::nearer::Nearer;
use cosfly_raster::visibility::{PlaneOnScreen, Screen, VisibilityBuffer};

/// Which parts of a frame [`Renderer::render_parts`] makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameParts {
    /// Visibility only: what is nearest at each pixel.
    Visibility,
    /// Visibility, depth, semantic and instance ids, target view.
    Ids,
    /// Everything.
    All,
}

/// Draws frames with one camera. Owns every buffer; keep one per thread.
pub struct Renderer {
    camera: Camera,
    screen: Screen,
    images: FrameImages,
    nearest: VisibilityBuffer,
    alone: VisibilityBuffer,
    nearer: Nearer,
    faces: Vec<DrawnFace>,
    /// First face of each part of a body, of faces that were found elsewhere.
    first_faces: Vec<u32>,
    visible: Vec<(u64, u32)>,
    /// A cluster's points in body axes and on the screen.
    seen_points: Vec<(DVec3, [f64; 2])>,
    people: People,
    occluders: Vec<u32>,
    covered: Vec<u32>,
    view: TargetView,
    others: Vec<BodyView>,
    runs: SeenRuns,
    level: Level,
    look: PictureLook,
    parallel: bool,
    shader: Shader,
    smoother: smooth::Smoother,
    optics: Optics,
    glass: Glass,
    composer: Composer,
    /// Colours of the scene's mesh at each pixel: light as it was scanned, or shares that it reflects; empty without a mesh.
    albedo: Vec<[f32; 3]>,
    /// Draws the frame without bodies, where splats need their shadows.
    bare: Option<Box<Renderer>>,
}

impl Renderer {
    /// A renderer for one camera.
    pub fn new(camera: Camera) -> Self {
        let screen = Screen::new(&camera);
        let pixels = screen.width * screen.height;
        let mut renderer = Self {
            camera,
            screen,
            images: FrameImages {
                width: camera.width,
                height: camera.height,
                rgb: vec![0; 3 * pixels],
                depth_m: vec![f32::INFINITY; pixels],
                semantic: vec![SemanticLabel::Sky.id(); pixels],
                instance: vec![0; pixels],
                on_request: Vec::new(),
            },
            nearest: VisibilityBuffer::new(screen.width, screen.height),
            alone: VisibilityBuffer::new(screen.width, screen.height),
            nearer: Nearer::default(),
            faces: Vec::new(),
            first_faces: Vec::new(),
            visible: Vec::new(),
            seen_points: Vec::new(),
            people: People::default(),
            occluders: Vec::new(),
            covered: Vec::new(),
            view: target_view::NOT_IN_VIEW,
            others: Vec::new(),
            runs: SeenRuns::default(),
            level: Level::best(),
            look: PictureLook::Full,
            parallel: false,
            shader: Shader::new(&screen),
            smoother: smooth::Smoother::default(),
            optics: Optics::IDEAL,
            glass: Glass::default(),
            composer: Composer::default(),
            albedo: Vec::new(),
            bare: None,
        };
        renderer.set_optics(cosfly_optics::of_mean_drone());
        renderer
    }

    /// The camera it draws with.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// Shades with these vector instructions from now on, to compare their bytes: they are the same.
    pub fn set_level(&mut self, level: Level) {
        self.level = level;
        self.shader.set_level(level);
        self.nearest.set_level(level);
        self.alone.set_level(level);
        self.bare = None;
    }

    /// Draws colours in this look from now on; all other channels are the same in each.
    pub fn set_look(&mut self, look: PictureLook) {
        self.look = look;
        self.shader.set_look(look);
    }

    /// Takes colours of the full look through these optics from now on; a middling drone's at first.
    pub fn set_optics(&mut self, optics: Optics) {
        self.optics = optics;
        self.bare = None;
        self.shader.set_optics(&optics);
    }

    /// Draws these channels from now on; the channels of every frame are always among them.
    pub fn set_channels(&mut self, channels: &ChannelSet) {
        let (on_request, pixels) =
            (channels.iter().filter(|channel| channel.is_on_request()), self.images.depth_m.len());
        self.images.on_request = on_request.map(|channel| ChannelImage::new(channel, pixels)).collect();
    }

    /// Spreads frames over the threads of the rayon pool that calls, from now on; the bytes are the same. Off at first:
    /// where a pool's tasks each draw frames of their own, its threads are busy, and one that waited for a frame's
    /// last band would begin another task meanwhile.
    pub fn set_parallel(&mut self, parallel: bool) {
        self.parallel = parallel;
        self.bare = None;
    }

    /// Draws all channels of one frame. The same scene and setup give the same bytes on any thread, after any other frame.
    pub fn render(&mut self, scene: &Scene, setup: &FrameSetup<'_>) -> RenderedFrame<'_> {
        self.render_parts(scene, setup, FrameParts::All)
    }

    /// Draws a frame up to a stage; channels of later stages keep what they held. For measuring.
    pub fn render_parts(&mut self, scene: &Scene, setup: &FrameSetup<'_>, parts: FrameParts) -> RenderedFrame<'_> {
        self.draw(scene, setup, parts, &mut Stopwatch::new(None));
        self.finished()
    }

    /// Draws all channels and says how long each stage took by the clock `now`.
    pub fn render_timed(
        &mut self,
        scene: &Scene,
        setup: &FrameSetup<'_>,
        now: &dyn Fn() -> u64,
    ) -> (RenderedFrame<'_>, Stages) {
        let mut watch = Stopwatch::new(Some(now));
        self.draw(scene, setup, FrameParts::All, &mut watch);
        (self.finished(), watch.stages())
    }

    /// Draws all channels, and gives the colours to `retouch` before anybody sees them.
    pub fn render_retouched(
        &mut self,
        scene: &Scene,
        setup: &FrameSetup<'_>,
        retouch: impl FnOnce(&mut [u8]),
    ) -> RenderedFrame<'_> {
        self.draw(scene, setup, FrameParts::All, &mut Stopwatch::new(None));
        retouch(&mut self.images.rgb);
        self.finished()
    }

    /// Visits what is seen at each pixel of the frame that was drawn last, from its pose.
    pub fn for_each_point(&self, pose: &Pose, visit: &mut dyn FnMut(usize, &SeenPoint)) {
        let seen = (&self.nearest.face[..], &self.faces[..]);
        on_request::for_each_point(&self.images, seen, (&Eye::new(pose), &self.screen), visit);
    }

    /// Images of the frame that was drawn last.
    /// A renderer of the same camera, with no channels on request.
    pub(crate) fn beside(&self) -> Self {
        let mut beside = Self::new(self.camera);
        beside.set_level(self.level);
        beside.set_parallel(self.parallel);
        beside
    }

    /// Draws in the look and through the optics of another renderer from now on.
    pub(crate) fn look_as(&mut self, other: &Self) {
        self.set_look(other.look);
        if self.optics != other.optics {
            self.set_optics(other.optics);
        }
    }

    pub(crate) fn images_mut(&mut self) -> &mut FrameImages {
        &mut self.images
    }

    pub(crate) fn finished(&self) -> RenderedFrame<'_> {
        RenderedFrame {
            images: &self.images,
            target_view: self.view,
            target_pixels: &self.covered,
            others: &self.others,
        }
    }

    fn draw(&mut self, scene: &Scene, setup: &FrameSetup<'_>, parts: FrameParts, watch: &mut Stopwatch<'_>) {
        let eye = Eye::new(&setup.pose);
        self.find_faces(scene, setup, &eye, watch);
        if parts == FrameParts::All {
            self.shader.prepare(scene, setup, &eye, &self.people, &self.nearest);
            watch.lap(2);
        }
        self.view = target_view::NOT_IN_VIEW;
        if parts == FrameParts::All {
            self.find_albedo(scene, setup);
        }
        if parts != FrameParts::Visibility {
            self.fill_channels(scene, parts == FrameParts::All);
            // Splats hide bodies: labels follow before they are counted.
            if parts == FrameParts::All && scene.has_light_of_its_own() {
                self.measure_shadows(scene, setup);
                self.composer.ground.note(&self.images.rgb, &self.images.semantic);
                self.draw_mesh(scene);
                self.draw_splats(scene, setup);
                self.composer.ground.compare(&self.images.rgb);
            }
            if !self.images.on_request.is_empty() {
                on_request::draw(&mut self.images, &self.nearest.face, &self.faces, &eye, &self.screen);
            }
            watch.lap(3);
            if setup.target.is_some() {
                target_view::covered_pixels(&self.alone, self.screen.width, &mut self.covered);
                self.view = target_view::measure(&self.images, &self.covered, &mut self.occluders);
            }
            target_view::draw_alone(&mut self.images, &self.covered);
            target_view::measure_bodies(self.level, &self.images, setup.others, &mut self.others);
            watch.lap(4);
        }
        if parts == FrameParts::All && self.look == PictureLook::Full {
            self.smooth_edges(scene);
            watch.lap(5);
            self.finish_colours();
            watch.lap(6);
        }
    }

    /// Finds what is nearest at each pixel.
    fn find_faces(&mut self, scene: &Scene, setup: &FrameSetup<'_>, eye: &Eye, watch: &mut Stopwatch<'_>) {
        self.nearest.clear();
        self.alone.clear();
        self.faces.clear();
        self.covered.clear();
        self.others.clear();
        match &scene.mesh {
            Some(mesh) => self.draw_mesh_faces(mesh, eye),
            None => {
                self.draw_boxes(scene, eye);
                self.draw_props(scene, eye);
            }
        }
        self.draw_people(scene, eye, setup);
        watch.lap(0);
        self.draw_ground(scene, eye);
        if scene.mesh.is_some() {
            self.bring_ground_forward();
        }
        watch.lap(1);
    }

    /// Depth, ids and colours as they are before edges are smoothed.
    fn shade_faces(&mut self, scene: &Scene, setup: &FrameSetup<'_>) {
        let eye = Eye::new(&setup.pose);
        self.find_faces(scene, setup, &eye, &mut Stopwatch::new(None));
        self.shader.prepare(scene, setup, &eye, &self.people, &self.nearest);
        // A mesh with a light of its own has its colours later.
        if scene.lit_mesh().is_some() {
            self.find_albedo(scene, setup);
        }
        self.fill_channels(scene, true);
    }

    /// Broken edges of crowns, and no stair steps along all others.
    fn smooth_edges(&mut self, scene: &Scene) {
        if scene.splats.is_none() {
            self.shader.fray(scene, &self.runs, &mut self.images);
        }
        self.smoother.smooth(self.runs.rows(), self.screen.width, &mut self.images.rgb);
    }

    /// Rain, and the light's way through the lens.
    fn finish_colours(&mut self) {
        self.shader.overlay(&mut self.images);
        let FrameImages { width, rgb, .. } = &mut self.images;
        self.glass.see(self.level, &self.optics, self.shader.is_night(), *width as usize, rgb);
    }

    /// Depth and ids, and RGB before smoothing, band by band while a band's pixels are at hand.
    fn fill_channels(&mut self, scene: &Scene, shaded: bool) {
        let (level, shader) = (self.level, &self.shader);
        let seen = Seen { scene, faces: &self.faces, people: &self.people, albedo: &self.albedo };
        for_each_band(self.parallel, &self.nearest.face, &mut self.images, &mut self.runs, |mut band| {
            band.resolve(level, seen.faces);
            if shaded {
                shader.shade(&seen, &mut band);
            }
        });
    }

    /// Boxes from near to far, so that far ones mostly fail the depth comparison.
    fn draw_boxes(&mut self, scene: &Scene, eye: &Eye) {
        self.visible.clear();
        for (index, b) in scene.boxes.iter().enumerate() {
            if let Some(key) = eye.order_if_seen(&self.screen, b.center_in_world, b.half_bounds_m) {
                self.visible.push((key, index as u32));
            }
        }
        self.visible.sort_unstable();
        for position in 0..self.visible.len() {
            let index = self.visible[position].1;
            let b = &scene.boxes[index as usize];
            let corners = b.corners_in_world.map(|corner| eye.see(corner));
            let bias = box_lift(index);
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal_in_world = b.normal_in_world(face);
                let normal = eye.turn(normal_in_world);
                let quad = around.map(|corner| corners[corner]);
                if normal.dot(quad[0]) < 0.0
                    && let Some(plane) = PlaneOnScreen::new(&self.screen, normal, quad[0])
                {
                    let number = self.faces.len() as u32;
                    self.nearest.draw_polygon(&self.screen, &quad, &plane, bias, number);
                    let source = FaceSource::of_box(scene, index, face as u8);
                    let normal = normal_in_world.as_vec3().to_array();
                    self.faces.push(DrawnFace { plane, normal, source, label: b.label, instance: b.instance });
                }
            }
        }
    }

    /// Models of things, from near to far.
    fn draw_props(&mut self, scene: &Scene, eye: &Eye) {
        self.visible.clear();
        for (index, prop) in scene.props.props.iter().enumerate() {
            if let Some(key) = eye.order_if_seen(&self.screen, prop.center_in_world, prop.half_bounds_m) {
                self.visible.push((key, index as u32));
            }
        }
        self.visible.sort_unstable();
        for position in 0..self.visible.len() {
            let prop = &scene.props.props[self.visible[position].1 as usize];
            for number in prop.triangles.clone() {
                let triangle = &scene.props.triangles[number];
                let corners = triangle.corners_in_world.map(|corner| eye.see(corner));
                let normal = eye.turn(triangle.normal_in_world);
                let side = if normal.dot(corners[0]) < 0.0 { 1.0 } else { -1.0 };
                if let Some(plane) = PlaneOnScreen::new(&self.screen, side * normal, corners[0]) {
                    let face = self.faces.len() as u32;
                    self.nearest.draw_polygon(&self.screen, &corners, &plane, 0.0, face);
                    let source = FaceSource::Prop { triangle: number as u32 };
                    let normal = (side * triangle.normal_in_world).as_vec3().to_array();
                    self.faces.push(DrawnFace { plane, normal, source, label: prop.label, instance: prop.instance });
                }
            }
        }
    }

    /// People, vehicles and cars of the town into the frame, and the target alone into its own buffer.
    fn draw_people(&mut self, scene: &Scene, eye: &Eye, setup: &FrameSetup<'_>) {
        let far = FarLight::of(setup.weather);
        self.people.begin(setup, eye, &self.screen, far);
        // What hides people hides the ground, too; that they hide some of it themselves is not worth another look.
        self.nearer.measure(&self.nearest);
        self.people.gather(setup.others, (eye, &self.screen), far, &self.nearer);
        // Cars that stand in a scan are in its mesh.
        let parked = if scene.mesh.is_some() { &[][..] } else { &scene.parked };
        self.people.gather_parked(parked, (eye, &self.screen), far, &self.nearer);
        for person in self.people.members.iter().filter(|person| person.is_seen) {
            let is_target = person.instance == TARGET_INSTANCE;
            // Look and first face of the parts of vehicles, whose faces come in any order, and of the last part of somebody.
            let mut parts = [None; Region::COUNT];
            let mut last = (u32::MAX, (0, 0));
            for (triangle_number, index) in (0..).zip(person.triangles.clone()) {
                let triangle = &self.people.triangles[index];
                // Most backs are told without turning them.
                let towards = triangle.normal_in_world.dot(eye.position_in_world - triangle.corners_in_world[0]);
                if towards < -1e-6 {
                    continue;
                }
                let corners = triangle.corners_in_world.map(|corner| eye.see(corner));
                let normal = eye.turn(triangle.normal_in_world);
                if normal.dot(corners[0]) < 0.0
                    && let Some(plane) = PlaneOnScreen::new(&self.screen, normal, corners[0])
                {
                    let number = self.faces.len() as u32;
                    let is_cloth = triangle.region.is_of_people();
                    let known = if is_cloth {
                        (last.0 == triangle.part).then_some(last.1)
                    } else {
                        parts[triangle.region as usize]
                    };
                    let (look, first_face) = known.unwrap_or((self.people.looks.len() as u32, number));
                    if known.is_none() {
                        let (person, region) = (triangle.person, triangle.region);
                        let middle_in_world = triangle.middle_in_world;
                        self.people.looks.push(PartLook { person, region, middle_in_world });
                    }
                    if is_cloth {
                        last = (triangle.part, (look, first_face));
                    } else {
                        parts[triangle.region as usize] = Some((look, first_face));
                    }
                    self.nearest.draw_polygon(&self.screen, &corners, &plane, 0.0, number);
                    if is_target {
                        self.alone.draw_polygon(&self.screen, &corners, &plane, 0.0, number);
                    }
                    let source = FaceSource::Figure { look, first_face, triangle: triangle_number, is_cloth };
                    let label = person.town_label.unwrap_or_else(|| person.figure.body.label(triangle.region)).id();
                    let normal = triangle.normal_in_world.as_vec3().to_array();
                    self.faces.push(DrawnFace { plane, normal, source, label, instance: person.instance });
                }
            }
        }
    }
}
