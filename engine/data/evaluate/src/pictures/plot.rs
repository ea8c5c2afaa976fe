//! The picture: the first metric by kind of frame with its intervals, beside classes or distances.

use super::report::PictureEvaluation;
use crate::report::score::Score;
use crate::report::table::title;
use cosfly_plot::axis::Axis;
use cosfly_plot::bars::{BAR_PX, Bar, Bars};
use cosfly_plot::document::ChartDocument;

/// Size and top edge of the panels, and left edges and widths of the two panels, pixels.
const WIDTH_PX: f64 = 980.0;
const TOP_PX: f64 = 64.0;
const LEFT: (f64, f64) = (210.0, 270.0);
const RIGHT: (f64, f64) = (660.0, 270.0);
/// Sequences that are shown.
const WORST: usize = 12;

impl PictureEvaluation {
    /// The picture, SVG; empty without a metric.
    pub fn to_svg(&self) -> String {
        let Some(metric) = self.metrics.first() else { return String::new() };
        let mut kinds: Vec<(String, Option<&Score>)> = vec![("all".to_owned(), self.scores.get(metric.key))];
        kinds.extend(self.strata_in_order().map(|(name, report)| (name, report.scores.get(metric.key))));
        let kinds: Vec<(String, Score)> = kinds.into_iter().filter_map(|(name, score)| Some((name, *score?))).collect();
        let (heading, others) = self.beside(metric.key, metric.name);
        let height = BAR_PX * kinds.len().max(others.len()) as f64;
        let name = format!("Scores of {} on {}", self.settings.kind.name(), self.dataset.name);
        let mut document = ChartDocument::new(&name, WIDTH_PX, TOP_PX + height + 40.0);
        document.heading((16.0, 26.0), &format!("{} with 95 % interval", title(metric)));
        document.heading((RIGHT.0 - 130.0, 26.0), &heading);
        bars(&mut document, LEFT, height, &kinds, "#2471a3");
        bars(&mut document, RIGHT, height, &others, "#1e8449");
        document.finish()
    }

    /// Heading and bars of the second panel: distances where there are some, classes, or sequences.
    fn beside(&self, key: &str, name: &str) -> (String, Vec<(String, Score)>) {
        let plain = |value: f64| Score { value, low: None, high: None };
        if !self.distances.is_empty() {
            let ranges = self.distances.iter();
            let bars = ranges.map(|range| (format!("{} to {} m", range.from_m, range.to_m), plain(range.abs_rel)));
            return ("AbsRel by true depth".to_owned(), bars.collect());
        }
        if self.classes.is_empty() {
            let worst = self.worst_sequences().into_iter().take(WORST);
            let bars = worst.filter_map(|report| Some((report.sequence.clone(), plain(*report.scores.get(key)?))));
            return (format!("{name} of the worst sequences"), bars.collect());
        }
        let has_iou = self.classes.iter().any(|class| class.scores.contains_key("iou"));
        let (key, name) = if has_iou { ("iou", "IoU") } else { (key, name) };
        let classes = self.classes.iter();
        let bars = classes.filter_map(|class| Some((class.name.to_owned(), plain(*class.scores.get(key)?))));
        (format!("{name} by class"), bars.collect())
    }
}

fn bars(document: &mut ChartDocument, (left, width): (f64, f64), height: f64, rows: &[(String, Score)], colour: &str) {
    let bars: Vec<Bar<'_>> = rows
        .iter()
        .map(|(name, score)| Bar { name, value: score.value, interval: score.low.zip(score.high), colour })
        .collect();
    let axis = Axis::to(bars.iter().map(Bar::end).fold(0.0, f64::max));
    Bars { left, top: TOP_PX, width, height, decimals: 3 }.draw(document, axis, &bars);
}
