"""Draws the boxes with OpenGL on the CPU (Mesa's llvmpipe): colour, planar depth and ids, read back.

usage: llvmpipe.py BOXES.json [--rounds N]
"""

import os

os.environ.setdefault("EGL_PLATFORM", "surfaceless")
os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
os.environ.setdefault("GALLIUM_DRIVER", "llvmpipe")
os.environ.setdefault("LP_NUM_THREADS", "0")

import moderngl
import numpy

from scene import Scene, arguments, least_cpu_ms, said

NEAR_M, FAR_M = 0.1, 2000.0

VERTEX = """
#version 330
uniform mat3 body_from_world;
uniform vec3 eye;
uniform vec4 lens;  // 2 f / width, 2 f / height, near, far
in vec3 corner;
in vec3 normal;
in vec3 center;
in vec3 half_extents;
in float yaw;
in uint instance;
out vec3 at_m;
out vec3 turned;
out float depth_m;
flat out uint id;
void main() {
    float c = cos(yaw), s = sin(yaw);
    mat3 turn = mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    vec3 point = center + turn * (corner * half_extents);
    vec3 seen = body_from_world * (point - eye);
    at_m = point;
    turned = turn * normal;
    depth_m = seen.x;
    id = instance;
    float n = lens.z, f = lens.w;
    gl_Position = vec4(lens.x * seen.y, lens.y * seen.z, ((f + n) * seen.x - 2.0 * f * n) / (f - n), seen.x);
}
"""

FRAGMENT = """
#version 330
in vec3 at_m;
in vec3 turned;
in float depth_m;
flat in uint id;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
layout(location = 2) out uint instance;
void main() {
    vec3 n = normalize(turned);
    float light = 0.35 + 0.65 * max(dot(n, normalize(vec3(0.4, 0.3, 0.8))), 0.0);
    float shade = fract(float(id) * 0.618);
    vec3 wall = mix(vec3(0.55, 0.45, 0.38), vec3(0.75, 0.73, 0.68), shade);
    if (abs(n.z) < 0.5 && id > 0u) {
        float along = abs(n.x) > 0.5 ? at_m.y : at_m.x;
        vec2 cell = fract(vec2(along / 2.4, at_m.z / 3.3));
        if (cell.x > 0.25 && cell.x < 0.75 && cell.y > 0.3 && cell.y < 0.8) wall = vec3(0.18, 0.24, 0.30);
    } else if (id == 0u) {
        vec2 paving = fract(at_m.xy / 4.0);
        wall = vec3(0.30) + 0.04 * step(0.5, paving.x) + 0.04 * step(0.5, paving.y);
    }
    float fog = 1.0 - exp(-0.002 * depth_m);
    colour = vec4(sqrt(mix(wall * light, vec3(0.7, 0.75, 0.8), fog)), 1.0);
    depth = depth_m;
    instance = id;
}
"""


def cube():
    """36 corners of a cube from -1 to 1 with their normals."""
    rows = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1)):
                corner, normal = [0.0] * 3, [0.0] * 3
                # The same winding seen from outside, whichever side it is.
                corner[axis], corner[u], corner[v], normal[axis] = sign, sign * a, b, sign
                rows.append(corner + normal)
    return numpy.array(rows, dtype=numpy.float32)


def main():
    options = arguments(__doc__)
    scene = Scene(options.boxes)
    context = moderngl.create_standalone_context(backend="egl")
    size = (scene.width, scene.height)
    targets = [context.texture(size, 4), context.texture(size, 1, dtype="f4"), context.texture(size, 1, dtype="u4")]
    frame = context.framebuffer(targets, context.depth_renderbuffer(size))
    program = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    program["lens"] = (2 * scene.focal_px / scene.width, 2 * scene.focal_px / scene.height, NEAR_M, FAR_M)
    low, high = numpy.array(scene.ground_low), numpy.array(scene.ground_high)
    ground_center = 0.5 * (low + high) * [1, 1, 0] + [0, 0, low[2] - 0.5]
    ground_half = 0.5 * (high - low) * [1, 1, 0] + [0, 0, 0.5]
    table = numpy.zeros(len(scene.instances) + 1, dtype=[("center", "3f4"), ("half", "3f4"), ("yaw", "f4"), ("id", "u4")])
    table["center"] = numpy.vstack([scene.centers, ground_center])
    table["half"] = numpy.vstack([scene.halves, ground_half])
    table["yaw"] = numpy.append(scene.yaws, 0.0)
    table["id"] = numpy.append(scene.instances, 0)
    vertices = context.vertex_array(
        program,
        [
            (context.buffer(cube().tobytes()), "3f4 3f4", "corner", "normal"),
            (context.buffer(table.tobytes()), "3f4 3f4 1f4 1u4/i", "center", "half_extents", "yaw", "instance"),
        ],
    )
    context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    context.front_face = "cw"  # the world is left-handed
    colour, depth, instance = (numpy.zeros(scene.width * scene.height, kind) for kind in ("u4", "f4", "u4"))

    def draw(view):
        position, world_from_body = view
        program["eye"] = tuple(position)
        # Columns first, as OpenGL wants them: the transpose of the transpose.
        program["body_from_world"] = tuple(world_from_body.flatten())
        frame.use()
        frame.clear(0.5, 0.7, 0.9, 1.0)
        vertices.render(instances=len(table))
        # As they lie in memory: no conversion on the way back.
        frame.read_into(colour, components=4, attachment=0)
        frame.read_into(depth, components=1, attachment=1, dtype="f4")
        frame.read_into(instance, components=1, attachment=2, dtype="u4")

    cpu_ms = least_cpu_ms(draw, scene.views, options.rounds)
    draw(scene.views[0])
    print(context.info["GL_RENDERER"])
    said("llvmpipe", scene, cpu_ms, depth, instance)


if __name__ == "__main__":
    main()
