//! Shapes of cars and vans, a row each: x is a share of the length ahead of the middle, z a share of the height.

use crate::region::Region;
use Region::{Glass as G, HeadLamp as H, Paint as P, Trim as T};

/// A cross-section, and the materials from it to the next one towards the nose.
#[derive(Clone, Copy)]
pub(super) struct Section {
    pub x: f64,
    /// Height of the shoulder, where the windows begin.
    pub shoulder: f64,
    /// Height of the middle of roof, bonnet or boot.
    pub top: f64,
    /// Whether a roof is above the shoulder.
    pub roofed: bool,
    /// Below the shoulder, above it, and on top.
    pub regions: [Region; 3],
}

/// A bonnet, a boot or a bed.
pub(super) const fn deck(x: f64, shoulder: f64, top: f64, regions: [Region; 3]) -> Section {
    Section { x, shoulder, top, roofed: false, regions }
}

/// A roof.
pub(super) const fn roof(x: f64, shoulder: f64, top: f64, regions: [Region; 3]) -> Section {
    Section { x, shoulder, top, roofed: true, regions }
}

/// Shape of a car or van.
pub(super) struct Shape {
    /// Share among the shapes that fit.
    pub share: f64,
    /// Lengths and heights of the boxes that it fits, metres.
    pub lengths_m: [f64; 2],
    pub heights_m: [f64; 2],
    /// Height of the sheet's lower edge.
    pub foot: f64,
    /// Half the width between the upper edges of the windows, in half widths.
    pub tumble: f64,
    /// How far the roof falls to its edges.
    pub drop: f64,
    /// Half the width of the sheet, in widths: mirrors reach farther.
    pub sheet: f64,
    /// How much both ends narrow.
    pub narrow: f64,
    /// Middles of the axles.
    pub axles: [f64; 2],
    /// Radius of the wheels, in heights.
    pub wheel: f64,
    /// Dark cladding above the lower edge.
    pub cladding: bool,
    /// Bars along the roof.
    pub rails: bool,
    /// From tail to nose.
    pub sections: &'static [Section],
}

/// Shape that buses, coaches and the cabs of lorries begin with: a length and a height of any size, cladding, no rails.
pub(super) const LARGE: Shape = Shape {
    share: 1.0,
    lengths_m: [0.0, 99.0],
    heights_m: [0.0, 99.0],
    foot: 0.09,
    tumble: 0.95,
    drop: 0.08,
    sheet: 0.486,
    narrow: 0.01,
    axles: [-0.26, 0.27],
    wheel: 0.15,
    cladding: true,
    rails: false,
    sections: &[],
};

/// Half width of their straight sheet, as a share of the width: wheels reach a little farther.
pub(super) const STRAIGHT: [f64; 2] = [0.494, 0.494];

/// The nose of most cars, from the foot of the windscreen: its heights are those of the cowl.
macro_rules! car {
    ($($tail:expr),+ ; $cowl:expr, $shoulder:expr, $top:expr, $edge:expr) => {
        &[
            $($tail,)+
            deck($cowl, $shoulder, $top, [P, P, T]),
            deck($cowl + 0.018, $shoulder, $top - 0.004, [P, P, P]),
            deck(0.5 * ($cowl + 0.44), $shoulder - 0.015, $top - 0.03, [P, P, P]),
            deck(0.44, $edge + 0.02, $edge + 0.075, [H, P, P]),
            deck(0.484, $edge - 0.04, $edge, [H, H, P]),
            deck(0.5, $edge - 0.12, $edge - 0.085, [P, P, P]),
        ]
    };
}

/// Shapes of passenger cars. Of those in traffic, a quarter each are saloons, hatchbacks and off-road cars.
pub(super) const CARS: [Shape; 8] = [
    // A small hatchback.
    Shape {
        share: 0.34,
        lengths_m: [0.0, 4.45],
        heights_m: [0.0, 1.62],
        foot: 0.125,
        tumble: 0.72,
        drop: 0.075,
        sheet: 0.472,
        narrow: 0.26,
        axles: [-0.315, 0.305],
        wheel: 0.212,
        cladding: false,
        rails: false,
        sections: car![
            deck(-0.5, 0.38, 0.44, [P, P, P]),
            deck(-0.49, 0.53, 0.61, [P, P, P]),
            deck(-0.472, 0.62, 0.69, [P, P, G]),
            roof(-0.385, 0.64, 0.935, [P, P, P]),
            roof(-0.315, 0.645, 0.968, [P, G, P]),
            roof(-0.105, 0.64, 1.0, [P, T, P]),
            roof(-0.078, 0.64, 1.0, [P, G, P]),
            roof(0.03, 0.63, 0.965, [P, G, G])
            ; 0.25, 0.61, 0.69, 0.52
        ],
    },
    // A saloon.
    Shape {
        share: 1.2,
        lengths_m: [4.1, 9.0],
        heights_m: [0.0, 1.58],
        foot: 0.12,
        tumble: 0.70,
        drop: 0.08,
        sheet: 0.472,
        narrow: 0.24,
        axles: [-0.278, 0.322],
        wheel: 0.218,
        cladding: false,
        rails: false,
        sections: car![
            deck(-0.5, 0.40, 0.47, [P, P, P]),
            deck(-0.49, 0.55, 0.64, [P, P, P]),
            deck(-0.465, 0.62, 0.715, [P, P, P]),
            deck(-0.375, 0.635, 0.725, [P, P, G]),
            roof(-0.225, 0.645, 0.955, [P, G, P]),
            roof(-0.098, 0.645, 0.995, [P, T, P]),
            roof(-0.074, 0.645, 1.0, [P, G, P]),
            roof(0.005, 0.635, 0.968, [P, G, G])
            ; 0.205, 0.615, 0.695, 0.52
        ],
    },
    // An estate.
    Shape {
        share: 0.14,
        lengths_m: [4.35, 9.0],
        heights_m: [1.4, 1.6],
        foot: 0.12,
        tumble: 0.72,
        drop: 0.075,
        sheet: 0.472,
        narrow: 0.23,
        axles: [-0.282, 0.317],
        wheel: 0.215,
        cladding: false,
        rails: true,
        sections: car![
            deck(-0.5, 0.39, 0.46, [P, P, P]),
            deck(-0.492, 0.56, 0.64, [P, P, P]),
            deck(-0.48, 0.62, 0.69, [P, P, G]),
            roof(-0.405, 0.64, 0.925, [P, P, P]),
            roof(-0.365, 0.645, 0.952, [P, G, P]),
            roof(-0.235, 0.645, 0.985, [P, T, P]),
            roof(-0.215, 0.645, 0.99, [P, G, P]),
            roof(-0.095, 0.64, 1.0, [P, T, P]),
            roof(-0.072, 0.64, 1.0, [P, G, P]),
            roof(0.01, 0.63, 0.968, [P, G, G])
            ; 0.21, 0.61, 0.69, 0.51
        ],
    },
    // An off-road car.
    Shape {
        share: 0.36,
        lengths_m: [3.9, 9.0],
        heights_m: [1.53, 9.0],
        foot: 0.155,
        tumble: 0.75,
        drop: 0.07,
        sheet: 0.472,
        narrow: 0.20,
        axles: [-0.295, 0.31],
        wheel: 0.222,
        cladding: true,
        rails: true,
        sections: car![
            deck(-0.5, 0.40, 0.46, [P, P, P]),
            deck(-0.492, 0.57, 0.63, [P, P, P]),
            deck(-0.48, 0.625, 0.68, [P, P, G]),
            roof(-0.405, 0.64, 0.925, [P, P, P]),
            roof(-0.35, 0.645, 0.96, [P, G, P]),
            roof(-0.105, 0.64, 1.0, [P, T, P]),
            roof(-0.08, 0.64, 1.0, [P, G, P]),
            roof(0.015, 0.63, 0.965, [P, G, G])
            ; 0.20, 0.615, 0.68, 0.555
        ],
    },
    // A coupe whose roof falls to the tail.
    Shape {
        share: 0.24,
        lengths_m: [4.1, 9.0],
        heights_m: [0.0, 1.52],
        foot: 0.115,
        tumble: 0.68,
        drop: 0.09,
        sheet: 0.472,
        narrow: 0.27,
        axles: [-0.29, 0.312],
        wheel: 0.226,
        cladding: false,
        rails: false,
        sections: car![
            deck(-0.5, 0.42, 0.50, [P, P, P]),
            deck(-0.488, 0.56, 0.66, [P, P, P]),
            deck(-0.455, 0.63, 0.72, [P, P, G]),
            roof(-0.20, 0.645, 0.945, [P, G, P]),
            roof(-0.10, 0.645, 1.0, [P, G, P]),
            roof(-0.02, 0.635, 0.985, [P, G, G])
            ; 0.175, 0.60, 0.675, 0.50
        ],
    },
    // A people carrier.
    Shape {
        share: 0.06,
        lengths_m: [4.1, 9.0],
        heights_m: [1.56, 9.0],
        foot: 0.125,
        tumble: 0.74,
        drop: 0.065,
        sheet: 0.472,
        narrow: 0.22,
        axles: [-0.30, 0.315],
        wheel: 0.195,
        cladding: false,
        rails: false,
        sections: car![
            deck(-0.5, 0.36, 0.42, [P, P, P]),
            deck(-0.493, 0.52, 0.585, [P, P, P]),
            deck(-0.484, 0.56, 0.63, [P, P, G]),
            roof(-0.445, 0.58, 0.93, [P, P, P]),
            roof(-0.405, 0.585, 0.96, [P, G, P]),
            roof(-0.20, 0.585, 0.995, [P, T, P]),
            roof(-0.178, 0.585, 1.0, [P, G, P]),
            roof(0.0, 0.58, 0.995, [P, T, P]),
            roof(0.02, 0.58, 0.99, [P, G, P]),
            roof(0.085, 0.575, 0.965, [P, G, G])
            ; 0.30, 0.565, 0.635, 0.50
        ],
    },
    // A pick-up.
    Shape {
        share: 0.08,
        lengths_m: [4.5, 9.0],
        heights_m: [1.55, 9.0],
        foot: 0.19,
        tumble: 0.74,
        drop: 0.07,
        sheet: 0.472,
        narrow: 0.14,
        axles: [-0.29, 0.315],
        wheel: 0.222,
        cladding: true,
        rails: false,
        sections: car![
            deck(-0.5, 0.55, 0.565, [P, P, P]),
            deck(-0.485, 0.60, 0.60, [P, P, T]),
            deck(-0.13, 0.61, 0.61, [P, P, G]),
            roof(-0.115, 0.62, 0.955, [P, G, P]),
            roof(-0.02, 0.625, 1.0, [P, T, P]),
            roof(0.0, 0.625, 1.0, [P, G, P]),
            roof(0.06, 0.62, 0.965, [P, G, G])
            ; 0.20, 0.60, 0.665, 0.56
        ],
    },
    // A city car with a short nose.
    Shape {
        share: 0.22,
        lengths_m: [0.0, 3.95],
        heights_m: [1.42, 9.0],
        foot: 0.125,
        tumble: 0.73,
        drop: 0.07,
        sheet: 0.472,
        narrow: 0.25,
        axles: [-0.335, 0.33],
        wheel: 0.198,
        cladding: false,
        rails: false,
        sections: car![
            deck(-0.5, 0.38, 0.43, [P, P, P]),
            deck(-0.493, 0.54, 0.60, [P, P, P]),
            deck(-0.483, 0.60, 0.655, [P, P, G]),
            roof(-0.415, 0.62, 0.93, [P, P, P]),
            roof(-0.35, 0.625, 0.965, [P, G, P]),
            roof(-0.115, 0.62, 1.0, [P, T, P]),
            roof(-0.085, 0.62, 1.0, [P, G, P]),
            roof(0.06, 0.61, 0.965, [P, G, G])
            ; 0.275, 0.60, 0.665, 0.535
        ],
    },
];

/// Shapes of vans.
pub(super) const VANS: [Shape; 3] = [
    // A panel van.
    Shape {
        share: 0.55,
        lengths_m: [0.0, 99.0],
        heights_m: [0.0, 99.0],
        foot: 0.11,
        tumble: 0.90,
        drop: 0.05,
        sheet: 0.472,
        narrow: 0.12,
        axles: [-0.30, 0.317],
        wheel: 0.152,
        cladding: true,
        rails: false,
        sections: VAN,
    },
    // A minibus: windows all along.
    Shape {
        share: 0.25,
        lengths_m: [0.0, 99.0],
        heights_m: [0.0, 99.0],
        foot: 0.11,
        tumble: 0.89,
        drop: 0.055,
        sheet: 0.472,
        narrow: 0.13,
        axles: [-0.30, 0.317],
        wheel: 0.152,
        cladding: false,
        rails: false,
        sections: MINIBUS,
    },
    // A small van on the floor of a car.
    Shape {
        share: 0.8,
        lengths_m: [0.0, 5.2],
        heights_m: [0.0, 2.2],
        foot: 0.11,
        tumble: 0.87,
        drop: 0.05,
        sheet: 0.472,
        narrow: 0.18,
        axles: [-0.30, 0.315],
        wheel: 0.163,
        cladding: true,
        rails: false,
        sections: car![
            deck(-0.5, 0.40, 0.44, [P, P, P]),
            roof(-0.49, 0.50, 0.94, [P, P, P]),
            roof(-0.46, 0.50, 0.985, [P, P, P]),
            roof(0.0, 0.50, 1.0, [P, T, P]),
            roof(0.02, 0.50, 0.995, [P, G, P]),
            roof(0.10, 0.50, 0.96, [P, G, G])
            ; 0.27, 0.49, 0.53, 0.44
        ],
    },
];

const VAN: &[Section] = &[
    deck(-0.5, 0.36, 0.42, [P, P, P]),
    roof(-0.494, 0.45, 0.94, [P, P, P]),
    roof(-0.47, 0.45, 0.985, [P, P, P]),
    roof(0.10, 0.45, 1.0, [P, P, P]),
    roof(0.135, 0.45, 1.0, [P, G, P]),
    roof(0.215, 0.45, 0.96, [P, G, G]),
    deck(0.375, 0.435, 0.475, [P, P, T]),
    deck(0.388, 0.43, 0.469, [P, P, P]),
    deck(0.455, 0.38, 0.415, [H, P, P]),
    deck(0.49, 0.33, 0.355, [H, H, P]),
    deck(0.5, 0.26, 0.28, [P, P, P]),
];

const MINIBUS: &[Section] = &[
    deck(-0.5, 0.36, 0.42, [P, P, P]),
    deck(-0.495, 0.45, 0.50, [P, P, G]),
    roof(-0.475, 0.46, 0.93, [P, P, P]),
    roof(-0.45, 0.46, 0.98, [P, G, P]),
    roof(-0.29, 0.46, 0.99, [P, T, P]),
    roof(-0.275, 0.46, 0.99, [P, G, P]),
    roof(-0.08, 0.46, 1.0, [P, T, P]),
    roof(-0.065, 0.46, 1.0, [P, G, P]),
    roof(0.105, 0.46, 1.0, [P, T, P]),
    roof(0.13, 0.46, 1.0, [P, G, P]),
    roof(0.215, 0.455, 0.96, [P, G, G]),
    deck(0.375, 0.435, 0.475, [P, P, T]),
    deck(0.388, 0.43, 0.469, [P, P, P]),
    deck(0.455, 0.38, 0.415, [H, P, P]),
    deck(0.49, 0.33, 0.355, [H, H, P]),
    deck(0.5, 0.26, 0.28, [P, P, P]),
];
