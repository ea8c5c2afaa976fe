// Which face is nearest at each pixel centre.

struct Eye {
    // Axes of the body in the world; `right` and `up` are divided by half the image in metres at 1 m.
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    // Relative to the middle of the mesh, metres; w is the near plane.
    position: vec4<f32>,
}

@group(0) @binding(0) var<uniform> eye: Eye;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) number: u32,
}

@vertex
fn corner(@location(0) place: vec3<f32>, @location(1) number: u32, @location(2) lift: f32) -> Corner {
    let from_eye = place - eye.position.xyz;
    let ahead = dot(from_eye, eye.forward.xyz);
    // z / w is the near plane over the depth: linear over the image, larger is nearer.
    let clip = vec4<f32>(dot(from_eye, eye.right.xyz), dot(from_eye, eye.up.xyz), eye.position.w * lift, ahead);
    return Corner(clip, number);
}

@fragment
fn number(corner: Corner) -> @location(0) u32 {
    return corner.number;
}
