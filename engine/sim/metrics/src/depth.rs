//! Metrics of depth images: AbsRel, RMSE and delta1 (paper, table "Downstream task transfer").

/// Lower limit to which predictions are clamped, metres.
pub const MIN_DEPTH_M: f64 = 1e-3;

/// Scores of one image, or means of them over images. The paper does not specify mask and average; here pixels are
/// scored whose true depth is finite, positive and at most the cap, predictions are clamped to [0.001 m, cap], and
/// every image has the same weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthScores {
    /// Mean of |predicted - true| / true.
    pub abs_rel: f64,
    /// Root mean squared difference, metres.
    pub rmse_m: f64,
    /// Share of pixels with max(predicted / true, true / predicted) < 1.25.
    pub delta1: f64,
}

/// Scores of an image; `None` when no pixel is scored. A NaN in the prediction counts as the cap.
pub fn depth_scores(predicted_m: &[f32], true_m: &[f32], cap_m: f64) -> Option<DepthScores> {
    let (mut sum, mut pixels) = (DepthScores::default(), 0_u64);
    for (predicted, truth) in predicted_m.iter().zip(true_m) {
        let truth = f64::from(*truth);
        if !(truth.is_finite() && truth > 0.0 && truth <= cap_m) {
            continue;
        }
        let predicted = f64::from(*predicted);
        let predicted = if predicted.is_nan() { cap_m } else { predicted.clamp(MIN_DEPTH_M.min(cap_m), cap_m) };
        let difference = predicted - truth;
        sum.abs_rel += difference.abs() / truth;
        sum.rmse_m += difference * difference;
        sum.delta1 += f64::from(u8::from((predicted / truth).max(truth / predicted) < 1.25));
        pixels += 1;
    }
    (pixels > 0).then(|| {
        let pixels = pixels as f64;
        DepthScores { abs_rel: sum.abs_rel / pixels, rmse_m: (sum.rmse_m / pixels).sqrt(), delta1: sum.delta1 / pixels }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sky_and_what_is_beyond_the_cap_do_not_count() {
        let truth = [10.0, f32::INFINITY, 200.0, 0.0, 20.0];
        let scores = depth_scores(&[11.0, 5.0, 5.0, 5.0, 40.0], &truth, 80.0).unwrap();
        assert!((scores.abs_rel - 0.55).abs() < 1e-12 && scores.delta1 == 0.5);
        assert!((scores.rmse_m - (401.0_f64 / 2.0).sqrt()).abs() < 1e-12);
        assert_eq!(depth_scores(&[1.0], &[f32::INFINITY], 80.0), None);
    }

    #[test]
    fn what_is_no_number_is_as_wrong_as_can_be() {
        assert_eq!(depth_scores(&[f32::NAN], &[40.0], 80.0).unwrap().abs_rel, 1.0);
        assert!(depth_scores(&[-3.0], &[40.0], 80.0).unwrap().delta1 == 0.0);
    }
}
