//! The facts of a frame in words, English or Chinese.

use crate::shared_options::InstructionLanguage;
use cosfly_captions::Language;
use cosfly_captions::refer::noun;
use serde_json::Value;

/// Cause of a loss whose target the camera does not look at.
pub(super) const OUT_OF_VIEW: &str = "out of view";
/// Cause of a loss whose target is in the picture.
pub(super) const TOO_SMALL: &str = "smaller than a pixel";

/// Chinese words for kinds of objects.
#[rustfmt::skip] // an entry per line
const CHINESE: &[(&str, &str)] = &[
    ("building", "建筑"),
    ("wall", "墙"),
    ("fence", "围栏"),
    ("tree_trunk", "树"),
    ("tree_crown", "树"),
    ("bush", "灌木"),
    ("pole", "杆子"),
    ("lamp", "路灯"),
    ("traffic_light", "交通灯"),
    ("traffic_sign", "交通标志"),
    ("guard_rail", "护栏"),
    ("bridge", "桥"),
    ("static", "固定物体"),
    ("bench", "长椅"),
    ("stall", "摊位"),
    ("car", "汽车"),
];

/// Words for an object that hides a target, with its instance id: trunk and crown are parts of one tree. Instance 0 is the ground.
pub(super) fn object(language: InstructionLanguage, kind: Option<&str>, instance: u32) -> String {
    let chinese = |kind: &str| CHINESE.iter().find(|it| it.0 == kind).map_or("物体", |it| it.1);
    match (language, kind) {
        (InstructionLanguage::En, _) if instance == 0 => "the ground".into(),
        (InstructionLanguage::Zh, _) if instance == 0 => "地面".into(),
        (InstructionLanguage::En, Some("tree_trunk" | "tree_crown")) => format!("tree {instance}"),
        (InstructionLanguage::En, kind) => format!("{} {instance}", kind.unwrap_or("body").replace('_', " ")),
        (InstructionLanguage::Zh, kind) => format!("{} {instance} ", chinese(kind.unwrap_or_default())),
    }
}

/// Words for a person, vehicle or drone that hides a target, with its instance id.
pub(super) fn body(language: InstructionLanguage, kind: &str, instance: u32) -> String {
    match language {
        InstructionLanguage::En => format!("{} {instance}", noun(kind, Language::En).unwrap_or("body")),
        InstructionLanguage::Zh => format!("{} {instance} ", noun(kind, Language::Zh).unwrap_or("物体")),
    }
}

/// Sight of the target in a frame.
pub(super) struct Shown<'a> {
    /// Visible pixels of the target.
    pub(super) pixels: u32,
    /// Share of the target that is hidden, percent.
    pub(super) hidden_percent: f64,
    /// Name of the body or thing that hides most of the target, in words; nothing where nothing does.
    pub(super) hidden_by: Option<String>,
    /// The loss as the line has it, or null.
    pub(super) loss: &'a Value,
    /// Name of the body or thing that hides the target in most frames of the loss, in words.
    pub(super) cause: String,
}

impl Shown<'_> {
    /// The reason in words, with the numbers of the line.
    pub(super) fn in_words(&self, language: InstructionLanguage) -> String {
        match language {
            InstructionLanguage::En => self.english(),
            InstructionLanguage::Zh => self.chinese(),
        }
    }

    /// Seconds since the loss began; none where it begins now.
    fn lost_for_s(&self) -> Option<f64> {
        self.loss["lost_for_s"].as_f64().filter(|lost_for_s| *lost_for_s > 0.0)
    }

    /// Direction in which the target comes back, degrees right of the camera's axis; none where it does not.
    fn bearing_deg(&self) -> Option<f64> {
        self.loss["comes_back"]["bearing_deg"].as_f64()
    }

    fn english(&self) -> String {
        let hidden = self.hidden_percent;
        if self.loss.is_null() {
            return match &self.hidden_by {
                _ if self.pixels == 0 => "The target has no body to see.".into(),
                None => "The target is in view.".into(),
                Some(by) => format!("The target is in view; {by} hides {hidden:.0} % of it."),
            };
        }
        let why = match self.loss["cause"].as_str() {
            Some(cause @ (OUT_OF_VIEW | TOO_SMALL)) => format!("it is {cause}"),
            _ => format!("{} hides it", self.cause),
        };
        let since = match self.lost_for_s() {
            Some(lost_for_s) => format!("The target has been lost for {lost_for_s} s: {why}."),
            None => format!("The target is lost just now: {why}."),
        };
        let Some(bearing_deg) = self.bearing_deg() else {
            return format!("{since} It does not come back in this flight.");
        };
        let way = match bearing_deg {
            0.0 => "straight ahead of the camera".to_owned(),
            _ if bearing_deg < 0.0 => format!("{} degrees to the left of the camera's axis", -bearing_deg),
            _ => format!("{bearing_deg} degrees to the right of the camera's axis"),
        };
        let back = &self.loss["comes_back"];
        format!("{since} It comes back in {} s, {} m away, {way}.", back["in_s"], back["distance_m"])
    }

    fn chinese(&self) -> String {
        let hidden = self.hidden_percent;
        if self.loss.is_null() {
            return match &self.hidden_by {
                _ if self.pixels == 0 => "目标没有可见的身体。".into(),
                None => "目标在画面里。".into(),
                Some(by) => format!("目标在画面里；{by}挡住了它的 {hidden:.0} %。"),
            };
        }
        let why = match self.loss["cause"].as_str() {
            Some(OUT_OF_VIEW) => "它在画面之外".to_owned(),
            Some(TOO_SMALL) => "它小于一个像素".to_owned(),
            _ => format!("{}挡住了它", self.cause),
        };
        let since = match self.lost_for_s() {
            Some(lost_for_s) => format!("目标已丢失 {lost_for_s} 秒：{why}。"),
            None => format!("目标刚刚丢失：{why}。"),
        };
        let Some(bearing_deg) = self.bearing_deg() else {
            return format!("{since}它在这次飞行中不再出现。");
        };
        let way = match bearing_deg {
            0.0 => "相机正前方".to_owned(),
            _ if bearing_deg < 0.0 => format!("相机轴线左侧 {} 度", -bearing_deg),
            _ => format!("相机轴线右侧 {bearing_deg} 度"),
        };
        let back = &self.loss["comes_back"];
        format!("{since}它将在 {} 秒后重新出现，距离 {} 米，在{way}。", back["in_s"], back["distance_m"])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{BodyKind, ObstacleKind};
    use cosfly_schema::tables::kind_name;

    #[test]
    fn every_kind_has_a_word() {
        use ObstacleKind::*;
        let objects = [Building, Wall, Fence, TreeTrunk, TreeCrown, Bush, Pole, Lamp, TrafficLight, TrafficSign];
        for kind in objects.into_iter().chain([GuardRail, Bridge, Car, Static, Bench, Stall]).map(kind_name) {
            assert!(CHINESE.iter().any(|it| it.0 == kind), "{kind}");
        }
        for kind in BodyKind::ON_THE_GROUND.iter().chain([&BodyKind::Drone]).map(|kind| kind.name()) {
            assert!([Language::En, Language::Zh].iter().all(|it| noun(kind, *it).is_some()), "{kind}");
        }
        assert_eq!(object(InstructionLanguage::Zh, Some("tree_crown"), 12), "树 12 ");
        assert_eq!(object(InstructionLanguage::En, Some("guard_rail"), 12), "guard rail 12");
        let bus = [InstructionLanguage::En, InstructionLanguage::Zh].map(|it| body(it, "bus", 12));
        assert_eq!(bus, ["bus 12", "公交车 12 "]);
        assert_eq!(body(InstructionLanguage::En, "unknown", 12), "body 12");
    }
}
