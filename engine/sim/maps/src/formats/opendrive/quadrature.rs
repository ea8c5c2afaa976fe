//! Gauss-Legendre integration, for clothoids and arc lengths.

const NODES: [f64; 4] =
    [0.183_434_642_495_649_8, 0.525_532_409_916_329, 0.796_666_477_413_626_7, 0.960_289_856_497_536_3];
const WEIGHTS: [f64; 4] =
    [0.362_683_783_378_362, 0.313_706_645_877_887_3, 0.222_381_034_453_374_5, 0.101_228_536_290_376_3];

/// The integral of the two-valued `f` from `from` to `to` with eight points on each of `panels` equal parts
/// (exact for polynomials of degree 15).
pub(super) fn integrate(from: f64, to: f64, panels: usize, f: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let half = 0.5 * (to - from) / panels as f64;
    let mut sum = (0.0, 0.0);
    for panel in 0..panels {
        let middle = from + half * (2 * panel + 1) as f64;
        for (node, weight) in NODES.iter().zip(WEIGHTS) {
            let (low, high) = (f(middle - half * node), f(middle + half * node));
            sum.0 += weight * (low.0 + high.0);
            sum.1 += weight * (low.1 + high.1);
        }
    }
    (half * sum.0, half * sum.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_fifteen_are_exact() {
        let (low, high) = integrate(-1.0, 2.0, 1, |x| (x.powi(15), x.powi(8)));
        assert!((low - (2f64.powi(16) - 1.0) / 16.0).abs() < 1e-9 && (high - (512.0 + 1.0) / 9.0).abs() < 1e-10);
    }
}
