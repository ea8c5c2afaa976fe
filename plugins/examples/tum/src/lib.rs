//! `tum`: writes the camera's and the target's way as TUM trajectory files, which `evo` and most SLAM tools read.

use cosfly_plugin::{Answer, Column, File, Flight, Gives, Metadata, Stage, libm, params, reals};

params! {
    /// How poses are written.
    pub struct Params {
        /// Whether the camera's axes are those of its image (x right, y down, z ahead); otherwise x ahead, y left, z up.
        optical: bool = true;
    }
}

/// See the crate.
pub struct Tum(Params);

/// A quaternion: x, y, z, w.
type Quaternion = [f64; 4];

impl Stage for Tum {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Writes the camera's and the target's way as TUM trajectory files.";
        Metadata { name: "tum", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        Ok(Self(params))
    }

    fn reads(&self) -> Vec<Column> {
        reals([
            "time_s",
            "drone_x",
            "drone_y",
            "drone_z",
            "camera_yaw",
            "camera_pitch",
            "camera_roll",
            "target_x",
            "target_y",
            "target_z",
            "target_heading",
        ])
    }

    fn gives(&self) -> Gives {
        Gives::Files("tum")
    }

    fn run(&self, flight: &Flight) -> Result<Answer, String> {
        let of = |name: &str| flight.column(name);
        let camera = [of("drone_x")?, of("drone_y")?, of("drone_z")?];
        let target = [of("target_x")?, of("target_y")?, of("target_z")?];
        let (yaw, pitch, roll) = (of("camera_yaw")?, of("camera_pitch")?, of("camera_roll")?);
        let (times, heading) = (of("time_s")?, of("target_heading")?);
        // From the axes of the image to x ahead, y left, z up.
        let image = [-0.5, 0.5, -0.5, 0.5];
        let of_camera = |k: usize| {
            let body = turned([yaw[k], pitch[k], roll[k]]);
            if self.0.optical { product(body, image) } else { body }
        };
        let content = |place: [&[f64]; 3], turn: &dyn Fn(usize) -> Quaternion| {
            let mut text = String::from("# timestamp tx ty tz qx qy qz qw: x east, y north, z up\n");
            for (k, time) in times.iter().enumerate() {
                let [qx, qy, qz, qw] = turn(k);
                let (x, y, z) = (place[0][k], -place[1][k], place[2][k]);
                text += &format!("{time:.6} {x:.9} {y:.9} {z:.9} {qx:.9} {qy:.9} {qz:.9} {qw:.9}\n");
            }
            text.into_bytes()
        };
        Ok(Answer::Files(vec![
            File { path: "camera.txt".to_owned(), content: content(camera, &of_camera) },
            File { path: "target.txt".to_owned(), content: content(target, &|k| turned([heading[k], 0.0, 0.0])) },
        ]))
    }
}

/// The attitude with these angles of the town's left-handed frame (yaw from x towards y, pitch up, roll to the right), in the
/// right-handed one whose y has the other sign.
fn turned([yaw, pitch, roll]: [f64; 3]) -> Quaternion {
    let half = |angle: f64| (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    let ((sz, cz), (sy, cy), (sx, cx)) = (half(-yaw), half(-pitch), half(roll));
    product(product([0.0, 0.0, sz, cz], [0.0, sy, 0.0, cy]), [sx, 0.0, 0.0, cx])
}

fn product([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion) -> Quaternion {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

cosfly_plugin::stage!(Tum);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_that_looks_east_and_down_is_written_in_right_handed_axes() {
        let quarter = core::f64::consts::FRAC_PI_2;
        let zero = [0.0; 1];
        let columns: Vec<(&str, &[f64])> = vec![
            ("time_s", &[0.5]),
            ("drone_x", &[1.0]),
            ("drone_y", &[2.0]),
            ("drone_z", &[3.0]),
            ("camera_yaw", &zero),
            ("camera_pitch", &[-0.5 * core::f64::consts::PI]),
            ("camera_roll", &zero),
            ("target_x", &zero),
            ("target_y", &zero),
            ("target_z", &zero),
            ("target_heading", &zero),
        ];
        let flight = Flight::new("p", &columns);
        let text = |optical: bool| {
            let Answer::Files(files) = Tum(Params { optical }).run(&flight).unwrap() else { panic!("files") };
            String::from_utf8(files[0].content.clone()).unwrap().lines().nth(1).unwrap().to_owned()
        };
        // Straight down: a quarter turn about the axis to the left.
        assert_eq!(
            text(false),
            "0.500000 1.000000000 -2.000000000 3.000000000 0.000000000 0.707106781 0.000000000 0.707106781"
        );
        assert!(text(true).starts_with("0.500000 1.000000000 -2.000000000 3.000000000 "));
        let north = turned([-quarter, 0.0, 0.0]);
        assert!((north[2] - 0.5_f64.sqrt()).abs() < 1e-12, "north is a quarter turn to the left");
    }
}
