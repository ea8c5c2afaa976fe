//! Depth, counted.

use super::tallies::Counted;
use cosfly_metrics::Metric;
use cosfly_metrics::depth::DepthScores;
use cosfly_metrics::scores::OF_DEPTH;

/// Sums over images by kind and group: AbsRel, RMSE, delta1, images.
pub struct DepthTallies {
    sums: Vec<Vec<[f64; 4]>>,
}

impl DepthTallies {
    /// Nothing counted yet.
    pub fn new(kinds: usize, groups: usize) -> Self {
        Self { sums: vec![vec![[0.0; 4]; groups]; kinds + 1] }
    }

    /// Counts an image.
    pub fn add(&mut self, kinds: &[usize], group: usize, scores: &DepthScores) {
        let values = [scores.abs_rel, scores.rmse_m, scores.delta1, 1.0];
        for kind in [0].into_iter().chain(kinds.iter().map(|kind| kind + 1)) {
            self.sums[kind][group].iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
    }
}

impl Counted for DepthTallies {
    fn metrics(&self) -> &'static [Metric] {
        &OF_DEPTH
    }

    fn means(&self, kind: usize, times: &dyn Fn(usize) -> u64) -> Vec<Option<f64>> {
        let mut total = [0.0; 4];
        for (group, sums) in self.sums[kind].iter().enumerate() {
            let times = times(group) as f64;
            total.iter_mut().zip(sums).for_each(|(total, sum)| *total += times * sum);
        }
        total[..3].iter().map(|sum| (total[3] > 0.0).then(|| sum / total[3])).collect()
    }
}
