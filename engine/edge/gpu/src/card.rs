//! The backend: one graphics card for all threads, one set of render targets per camera.

use crate::mesh::{Mesh, Vertex};
use bytemuck::{Pod, Zeroable};
use cosfly_domain::{Camera, ChannelSet};
use cosfly_frames::Pose;
use cosfly_optics::Optics;
use cosfly_render::outside::NO_FACE;
use cosfly_render::{Backend, BackendError, FrameSetup, PictureLook, RenderedFrame, Renderer, Scene};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Distance of the near plane along the optical axis, metres.
const NEAR_M: f32 = 0.01;
const NUMBERS: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// First card found, with the resources shared by all frames.
struct Card {
    name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Pipelines for boxes (back faces culled) and for ground.
    pipelines: [wgpu::RenderPipeline; 2],
    eyes: wgpu::BindGroupLayout,
    /// Last drawn mesh with its scene's identity: all threads draw the same town.
    mesh: Mutex<Option<(u64, Arc<UploadedMesh>)>>,
}

struct UploadedMesh {
    vertices: wgpu::Buffer,
    counts: [u32; 2],
    middle_in_world: cosfly_frames::DVec3,
}

/// Uniforms of a camera for the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Eye {
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    position: [f32; 4],
}

/// Renderer backend for one camera on the card.
pub struct GpuBackend {
    card: Arc<Card>,
    renderer: Renderer,
    numbers: wgpu::Texture,
    depth: wgpu::Texture,
    eye: wgpu::Buffer,
    bound: wgpu::BindGroup,
    staging: wgpu::Buffer,
    /// Bytes of a row in `staging`, a multiple of the card's copy alignment.
    pitch: u32,
    nearest: Vec<u32>,
}

impl GpuBackend {
    /// Creates a backend for one camera.
    ///
    /// # Errors
    /// The machine has no usable card, or the image is too large for it.
    pub fn new(camera: Camera) -> Result<Self, BackendError> {
        static CARD: OnceLock<Result<Arc<Card>, BackendError>> = OnceLock::new();
        let card = CARD.get_or_init(|| Card::open().map(Arc::new)).clone()?;
        let largest = card.device.limits().max_texture_dimension_2d;
        if camera.width.max(camera.height) > largest {
            return Err(BackendError {
                message: format!(
                    "`{}` draws images of at most {largest} pixels a side; {} x {} were requested",
                    card.name, camera.width, camera.height
                ),
                hint: "make the image smaller, or set `backend = \"cpu\"`".into(),
            });
        }
        let texture = |format, usage| {
            card.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: camera.width, height: camera.height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let buffer = |size, usage| {
            let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
            card.device.create_buffer(&descriptor)
        };
        let eye = buffer(size_of::<Eye>() as u64, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let bound = card.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &card.eyes,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: eye.as_entire_binding() }],
        });
        let pitch = (4 * camera.width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        Ok(Self {
            renderer: Renderer::new(camera),
            numbers: texture(NUMBERS, wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC),
            depth: texture(DEPTH, wgpu::TextureUsages::RENDER_ATTACHMENT),
            staging: buffer(
                u64::from(pitch) * u64::from(camera.height),
                wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            ),
            eye,
            bound,
            pitch,
            nearest: vec![NO_FACE; camera.width as usize * camera.height as usize],
            card,
        })
    }

    /// Sets the look of colours for the following frames.
    pub fn set_look(&mut self, look: PictureLook) {
        self.renderer.set_look(look);
    }

    /// Sets the optics of colours for the following frames.
    pub fn set_optics(&mut self, optics: Optics) {
        self.renderer.set_optics(optics);
    }

    /// Draws these channels from now on.
    pub fn set_channels(&mut self, channels: &ChannelSet) {
        self.renderer.set_channels(channels);
    }

    /// Name and driver of the card.
    pub fn card_name(&self) -> &str {
        &self.card.name
    }

    /// Renders the nearest faces and reads them back.
    fn find(&mut self, mesh: &UploadedMesh, pose: &Pose) -> Result<(), BackendError> {
        let camera = self.renderer.camera();
        self.card.queue.write_buffer(&self.eye, 0, bytemuck::bytes_of(&Eye::new(&camera, pose, mesh)));
        let mut encoder = self.card.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.draw(mesh, &mut encoder);
        encoder.copy_texture_to_buffer(
            self.numbers.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.pitch),
                    rows_per_image: None,
                },
            },
            self.numbers.size(),
        );
        self.card.queue.submit([encoder.finish()]);
        let mapped = Arc::new(OnceLock::new());
        let outcome = Arc::clone(&mapped);
        self.staging.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = outcome.set(result);
        });
        let waited = self.card.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| lost(&self.card.name, &error))?;
        match mapped.get() {
            Some(Ok(())) => {}
            Some(Err(error)) => return Err(lost(&self.card.name, error)),
            None => return Err(lost(&self.card.name, &"it did not answer")),
        }
        let bytes = self.staging.get_mapped_range(..);
        let width = camera.width as usize;
        for (row, line) in self.nearest.chunks_exact_mut(width).zip(bytes.chunks_exact(self.pitch as usize)) {
            row.copy_from_slice(bytemuck::cast_slice(&line[..4 * width]));
        }
        drop(bytes);
        self.staging.unmap();
        Ok(())
    }

    fn draw(&self, mesh: &UploadedMesh, encoder: &mut wgpu::CommandEncoder) {
        let [numbers, depth] = [&self.numbers, &self.depth].map(|it| it.create_view(&Default::default()));
        let nothing = wgpu::Color { r: f64::from(NO_FACE), g: 0.0, b: 0.0, a: 0.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &numbers,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(nothing), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.bound, &[]);
        pass.set_vertex_buffer(0, mesh.vertices.slice(..));
        let [boxes, all] = mesh.counts;
        for (pipeline, vertices) in self.card.pipelines.iter().zip([0..boxes, boxes..all]) {
            pass.set_pipeline(pipeline);
            pass.draw(vertices, 0..1);
        }
    }
}

impl Backend for GpuBackend {
    fn camera(&self) -> Camera {
        self.renderer.camera()
    }

    fn render(&mut self, scene: &Scene, setup: &FrameSetup<'_>) -> Result<RenderedFrame<'_>, BackendError> {
        let mesh = self.card.mesh_of(scene)?;
        self.find(&mesh, &setup.pose)?;
        Ok(self.renderer.render_found(scene, setup, &self.nearest))
    }
}

impl Card {
    fn open() -> Result<Self, BackendError> {
        let instance = wgpu::Instance::new(&wgpu::InstanceDescriptor::default());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let none = |message: String| BackendError {
            message,
            hint:
                "install a driver for Vulkan, Metal or Direct3D 12 (Mesa's `mesa-vulkan-drivers` draws without a card, \
                   slowly), or set `backend = \"cpu\"`"
                    .into(),
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| none(format!("no graphics card was found: {error}")))?;
        let info = adapter.get_info();
        let descriptor = wgpu::DeviceDescriptor {
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..wgpu::DeviceDescriptor::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| none(format!("`{}` could not be used: {error}", info.name)))?;
        let eyes = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let pipelines = [Some(wgpu::Face::Back), None].map(|cull_mode| pipeline(&device, &eyes, cull_mode));
        let name = format!("{} ({})", info.name, info.driver);
        Ok(Self { name, device, queue, pipelines, eyes, mesh: Mutex::new(None) })
    }

    /// Mesh of a scene, uploaded once.
    fn mesh_of(&self, scene: &Scene) -> Result<Arc<UploadedMesh>, BackendError> {
        let mut kept = self.mesh.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((identity, mesh)) = &*kept
            && *identity == scene.identity()
        {
            return Ok(Arc::clone(mesh));
        }
        let mesh = Mesh::new(scene);
        // An empty buffer cannot be bound.
        let bytes: &[u8] = if mesh.vertices.is_empty() { &[0; 60] } else { bytemuck::cast_slice(&mesh.vertices) };
        if bytes.len() as u64 > self.device.limits().max_buffer_size {
            return Err(BackendError {
                message: format!("the town has {} triangles, too many for `{}`", mesh.vertices.len() / 3, self.name),
                hint: "set `backend = \"cpu\"`".into(),
            });
        }
        let vertices = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&vertices, 0, bytes);
        let counts = [mesh.box_vertices, mesh.vertices.len() as u32];
        let uploaded = Arc::new(UploadedMesh { vertices, counts, middle_in_world: mesh.middle_in_world });
        *kept = Some((scene.identity(), Arc::clone(&uploaded)));
        Ok(uploaded)
    }
}

fn pipeline(
    device: &wgpu::Device,
    eyes: &wgpu::BindGroupLayout,
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let shader = device.create_shader_module(wgpu::include_wgsl!("nearest.wgsl"));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[eyes],
        ..wgpu::PipelineLayoutDescriptor::default()
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32, 2 => Float32],
            }],
        },
        primitive: wgpu::PrimitiveState {
            // The world is left-handed: seen from outside, corners run clockwise.
            front_face: wgpu::FrontFace::Cw,
            cull_mode,
            ..wgpu::PrimitiveState::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: true,
            depth_compare: wgpu::CompareFunction::Greater,
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: Some("number"),
            compilation_options: Default::default(),
            targets: &[Some(NUMBERS.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl Eye {
    fn new(camera: &Camera, pose: &Pose, mesh: &UploadedMesh) -> Self {
        let axes = pose.world_from_body();
        let focal = camera.focal_px();
        let right = axes.y_axis * (2.0 * focal / f64::from(camera.width));
        let up = axes.z_axis * (2.0 * focal / f64::from(camera.height));
        let position = pose.position_in_world - mesh.middle_in_world;
        let with = |v: cosfly_frames::DVec3, w: f32| v.as_vec3().extend(w).to_array();
        Self {
            right: with(right, 0.0),
            up: with(up, 0.0),
            forward: with(axes.x_axis, 0.0),
            position: with(position, NEAR_M),
        }
    }
}

fn lost(name: &str, error: &dyn std::fmt::Display) -> BackendError {
    BackendError {
        message: format!("`{name}` stopped working: {error}"),
        hint: "run again: finished items are kept; or set `backend = \"cpu\"`".into(),
    }
}
