// Render: facets in samples of the whole picture in, colours of a tile's samples out.
//
// Nothing is interpolated by the device: its sums depend on where a tile begins. A sample finds its
// weights by itself, from coordinates of the whole picture, which are the same in every tile; and
// with them its depth. So only coverage is the device's, of corners on a grid that it keeps.

struct Look {
    // The tile's first sample, and how many the viewport has: powers of two.
    origin: vec2<f32>,
    size: vec2<f32>,
    // 0 shaded, 1 wireframe, 2 heat map.
    paint: u32,
    // A heat map's scale: 1 for logarithms, and its ends.
    log: u32,
    least: f32,
    most: f32,
    // Width of a line in samples, and samples of a pixel along an axis.
    line: f32,
    samples: f32,
    spare: vec2<u32>,
    colours: array<vec4<f32>, 256>,
}

struct Corner {
    // x and y in samples of the picture, depth, 1 / w.
    place: vec4<f32>,
    normal: vec3<f32>,
    value: f32,
    view: vec3<f32>,
    // Of the first corner: bits of edges 0-1, 1-2, 2-0 that are lines, three more for those on a
    // patch's boundary, one for the back.
    flags: u32,
}

@group(0) @binding(0) var<uniform> look: Look;
@group(0) @binding(1) var<storage, read> corners: array<Corner>;

const SHADED = 0u;
const WIREFRAME = 1u;
const MAP = 2u;

const BACK = 64u;

// The key light stands to the left above the camera, the fill light lower on its right: axes are
// right, up, towards the viewer.
const KEY = vec3<f32>(-0.46, 0.62, 0.64);
const FILL = vec3<f32>(0.79, -0.08, 0.61);
const KEY_STRENGTH = 0.78;
const FILL_STRENGTH = 0.20;
// Light from everywhere, more of it from above.
const SKY = 0.17;
const GROUND = 0.07;
const GLOSS = 0.16;
const GLOSS_POWER = 36.0;

// Linear light that surfaces throw back: cool on the front, warm on the back, so that an inside is
// told from an outside.
const FRONT_COLOUR = vec3<f32>(0.50, 0.58, 0.68);
const BACK_COLOUR = vec3<f32>(0.66, 0.50, 0.36);
// Under lines surfaces are lighter.
const WHITENED = 0.45;

// Coded in sRGB, as all that follows light.
const INK = vec3<f32>(0.05, 0.11, 0.21);
const INK_OF_MAPS = vec3<f32>(0.02, 0.02, 0.04);
const INSIDE = 0.62;
const BOUNDARY = 0.95;
// Edges inside of patches hardly show on heat maps, whose colours are what is read.
const INSIDE_OF_MAPS = 0.14;
const BOUNDARY_OF_MAPS = 0.55;
// A triangle of less height than so many line widths has paler lines: crowded ones would be a blot.
const CROWDED = 5.0;

struct Drawn {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) facet: u32,
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> Drawn {
    let place = corners[index].place;
    let at = (place.xy - look.origin) / look.size * 2.0 - 1.0;
    // The sample's own depth replaces this one.
    return Drawn(vec4<f32>(at.x, -at.y, 0.5, 1.0), index / 3u);
}

fn cross2(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// How much of a sample at these weights a line covers, by its ink; `heights` are the triangle's.
fn inked(weights: vec3<f32>, heights: vec3<f32>, flags: u32, inside: f32, boundary: f32) -> f32 {
    var most = 0.0;
    let low = min(min(heights.x, heights.y), heights.z);
    let pale = clamp(low / (CROWDED * look.line), 0.2, 1.0);
    for (var k = 0u; k < 3u; k++) {
        if (flags >> k & 1u) == 0u {
            continue;
        }
        // Edge k begins at corner k, and lies opposite the one before it.
        let opposite = (k + 2u) % 3u;
        let away = weights[opposite] * heights[opposite];
        let on_boundary = (flags >> k & 8u) != 0u;
        // Half of a line is in the neighbour. A boundary's is twice as wide, but not beyond its
        // triangle: the next one may touch the boundary with a corner only.
        let half = select(0.5 * look.line, min(look.line, 0.5 * low + 0.5), on_boundary);
        let ink = select(inside * pale, boundary * max(pale, 0.5), on_boundary);
        most = max(most, ink * clamp(half + 0.5 - away, 0.0, 1.0));
    }
    return most;
}

fn coded(linear: vec3<f32>) -> vec3<f32> {
    let high = 1.055 * pow(max(linear, vec3<f32>(0.0)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * linear, linear <= vec3<f32>(0.0031308));
}

fn lit(normal: vec3<f32>, view: vec3<f32>, flags: u32) -> vec3<f32> {
    var colour = select(FRONT_COLOUR, BACK_COLOUR, (flags & BACK) != 0u);
    if look.paint == WIREFRAME {
        colour = mix(colour, vec3<f32>(1.0), WHITENED);
    }
    let key = KEY_STRENGTH * max(dot(normal, KEY), 0.0);
    let fill = FILL_STRENGTH * max(dot(normal, FILL), 0.0);
    let around = mix(GROUND, SKY, 0.5 + 0.5 * normal.y);
    let gloss = pow(max(dot(normal, normalize(KEY + view)), 0.0), GLOSS_POWER);
    return coded(min(colour * (key + fill + around) * 1.25 + GLOSS * gloss, vec3<f32>(1.0)));
}

fn on_scale(value: f32) -> vec3<f32> {
    var place = 0.5;
    if look.most > look.least {
        if look.log == 1u {
            // Nothing is below the least, whose logarithm is finite.
            place = log(max(value, look.least) / look.least) / log(look.most / look.least);
        } else {
            place = (value - look.least) / (look.most - look.least);
        }
    }
    let step = clamp(place, 0.0, 1.0) * 255.0;
    let below = u32(step);
    let above = min(below + 1u, 255u);
    return mix(look.colours[below].rgb, look.colours[above].rgb, step - f32(below));
}

struct Sample {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn sample(drawn: Drawn) -> Sample {
    let at = drawn.position.xy + look.origin;
    let first = 3u * drawn.facet;
    let a = corners[first];
    let b = corners[first + 1u];
    let c = corners[first + 2u];
    let ab = b.place.xy - a.place.xy;
    let bc = c.place.xy - b.place.xy;
    let ca = a.place.xy - c.place.xy;
    let area = cross2(ab, -ca);
    let weight = cross2(bc, at - b.place.xy) / area;
    let weight_b = cross2(ca, at - c.place.xy) / area;
    let weights = vec3<f32>(weight, weight_b, 1.0 - weight - weight_b);
    let depth = dot(weights, vec3<f32>(a.place.z, b.place.z, c.place.z));
    // Everything but depth is linear on the triangle itself, not on the screen.
    let scaled = weights * vec3<f32>(a.place.w, b.place.w, c.place.w);
    let real = scaled / (scaled.x + scaled.y + scaled.z);
    var colour: vec3<f32>;
    var ink = INK;
    var strength = vec2<f32>(INSIDE, BOUNDARY);
    if look.paint == MAP {
        colour = on_scale(dot(real, vec3<f32>(a.value, b.value, c.value)));
        ink = INK_OF_MAPS;
        strength = vec2<f32>(INSIDE_OF_MAPS, BOUNDARY_OF_MAPS);
    } else {
        let normal = real.x * a.normal + real.y * b.normal + real.z * c.normal;
        let view = real.x * a.view + real.y * b.view + real.z * c.view;
        colour = lit(normalize(normal), normalize(view), a.flags);
    }
    if look.paint != SHADED && look.line > 0.0 {
        let heights = abs(area) / vec3<f32>(length(bc), length(ca), length(ab));
        colour = mix(colour, ink, inked(weights, heights, a.flags, strength.x, strength.y));
    }
    return Sample(vec4<f32>(colour, 1.0), clamp(depth, 0.0, 1.0));
}
