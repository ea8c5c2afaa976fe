//! Chinese wordings of what a picture shows.

use super::beside::{Beside, NearLandmark, OnSide};
use super::facts::{Across, Place, Side, Sight};
use super::landmarks::LandmarkKind;
use super::relation::{Relation, relation};
use crate::chinese::{colour, numeral, who};
use crate::part::Part;
use crate::wording::one_of;
use cosfly_random::RandomStream;

/// `跟随身穿红色上衣、蓝色裤子的行人，此人走在另外两人前面，正背对镜头朝远处走去。`
pub(super) fn instruction(sight: &Sight, words: &mut RandomStream) -> String {
    let who = who(sight.wear.as_ref(), words);
    let follow = one_of(words, &["跟随", "请跟随", "跟踪", "请跟上"]);
    let Some(seen) = &sight.seen else {
        return format!("{follow}{who}，此人目前不在视野内。");
    };
    let relation = relation(seen).map(|it| relation_words(&it, words));
    let mut parts: Vec<String> =
        relation.into_iter().chain(seen.across.map(|it| across_words(it).to_owned())).collect();
    if words.chance(0.5) {
        parts.reverse();
    }
    parts.extend(seen.landmarks.first().map(landmark_words));
    match parts.join("，") {
        nothing if nothing.is_empty() => format!("{follow}{who}。"),
        parts => format!("{follow}{who}，此人{parts}。"),
    }
}

fn across_words(across: Across) -> &'static str {
    match across {
        Across::Away => "正背对镜头朝远处走去",
        Across::Towards => "正迎着镜头走来",
        Across::ToTheLeft => "正朝画面左侧走去",
        Across::ToTheRight => "正朝画面右侧走去",
        Across::Stands => "正站着不动",
    }
}

/// `正从左侧的一棵树旁走过`.
fn landmark_words(landmark: &NearLandmark) -> String {
    let thing = match landmark.kind {
        LandmarkKind::TrafficLight => "一处红绿灯",
        LandmarkKind::Lamp => "一盏路灯",
        LandmarkKind::TrafficSign => "一块交通标志牌",
        LandmarkKind::Tree => "一棵树",
        LandmarkKind::Car => "一辆停着的汽车",
        LandmarkKind::Building => "一栋楼房",
    };
    let side = match landmark.side {
        Some(OnSide::Left) => "左侧的",
        Some(OnSide::Right) => "右侧的",
        None => "",
    };
    match landmark.beside {
        Beside::Passes => format!("正从{side}{thing}旁走过"),
        Beside::Approaches => format!("正走近{thing}"),
        Beside::NextTo => format!("就在{thing}旁"),
        Beside::InFront => format!("位于{thing}前"),
    }
}

fn relation_words(relation: &Relation, words: &mut RandomStream) -> String {
    match *relation {
        Relation::One(place, top) => {
            let someone = format!("一名{}{}上衣的人", one_of(words, &["穿", "身穿"]), colour(top));
            match place {
                Place::Ahead => format!("走在{someone}前面"),
                Place::Behind => format!("走在{someone}后面"),
                Place::Beside => format!("与{someone}并排走着"),
            }
        }
        Relation::Several(place, count) => match place {
            Place::Ahead => format!("走在另外{}人前面", numeral(count)),
            Place::Behind => format!("走在另外{}人后面", numeral(count)),
            Place::Beside => format!("与另外{}人并排走着", numeral(count)),
        },
        Relation::Alone => one_of(words, &["是画面中唯一的人", "独自一人出现在画面中"]).to_owned(),
        Relation::Outermost(Side::Leftmost, count) => format!("是画面中{}个人里最左边的一个", numeral(count)),
        Relation::Outermost(Side::Rightmost, count) => format!("是画面中{}个人里最右边的一个", numeral(count)),
        Relation::Nearest => "是离镜头最近的人".to_owned(),
        Relation::In(Part::Left) => "位于画面左侧".to_owned(),
        Relation::In(Part::Middle) => "位于画面中央".to_owned(),
        Relation::In(Part::Right) => "位于画面右侧".to_owned(),
    }
}
