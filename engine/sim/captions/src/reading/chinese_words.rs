//! Chinese words by what they tell about a number or a garment.

use cosfly_render::Colour;

pub const ALTITUDE_WORDS: [&str; 8] = ["高", "上方", "头顶", "上空", "高度", "高处", "离地", "之上"];
pub const WAY_WORDS: [&str; 22] = [
    "这一趟",
    "这趟",
    "这段",
    "走出",
    "全程",
    "路程",
    "行程",
    "走了",
    "全长",
    "总长",
    "走过",
    "共走",
    "长约",
    "路线",
    "里程",
    "走完",
    "路长",
    "的路",
    "走到头",
    "步行",
    "路途",
    "距离全长",
];
pub const DISTANCE_WORDS: [&str; 15] =
    ["距", "保持", "间隔", "外", "远", "后方", "相隔", "隔", "间距", "拉开", "身后", "之后", "离", "跟拍", "跟随"];
pub const STANDING_WORDS: [&str; 16] = [
    "站立",
    "站着",
    "静止",
    "原地",
    "一动不动",
    "没有移动",
    "站在",
    "没有动",
    "没动",
    "一步没走",
    "没有走动",
    "没走动",
    "没挪",
    "不走动",
    "站定",
    "伫立",
];
pub const STRAIGHT_WORDS: [&str; 5] = ["直行", "笔直", "径直", "直走", "直线"];
pub const STOP_CHARS: [&str; 9] = ["停", "驻足", "歇", "逗留", "站住", "止步", "等了", "等待", "等候"];
/// First words of a clause that goes on about the stop before.
pub const GOES_ON: [&str; 14] =
    ["共", "约", "共约", "合计", "总共", "一共", "累计", "前后", "大约", "大概", "共计", "时长", "历时共", "加起来"];
/// Words of a clause whose time is not that of the stop before.
pub const NO_STOP: [&str; 14] =
    ["走", "用时", "历时", "耗时", "全程", "飞", "行", "米", "转", "拐", "全部", "整", "度", "花"];
pub const TOPS: [&str; 19] = [
    "上衣", "外套", "衬衫", "夹克", "卫衣", "毛衣", "短袖", "上装", "衣服", "衣裳", "大衣", "衫", "衣", "恤", "马甲",
    "风衣", "帽衫", "背心", "棉服",
];
pub const TROUSERS: [&str; 8] = ["裤子", "长裤", "牛仔裤", "裤装", "短裤", "裤", "牛仔", "运动裤"];
/// Colours that no garment here has a name for.
pub const OTHER_COLOURS: [&str; 8] = ["藏青", "青色", "金色", "银色", "卡其", "墨绿", "天蓝", "米白"];

pub const COLOURS: [(&str, Colour); 17] = [
    ("粉红", Colour::Pink),
    ("橙黄", Colour::Orange),
    ("橘", Colour::Orange),
    ("褐", Colour::Brown),
    ("咖啡", Colour::Brown),
    ("黑", Colour::Black),
    ("灰", Colour::Grey),
    ("白", Colour::White),
    ("红", Colour::Red),
    ("橙", Colour::Orange),
    ("黄", Colour::Yellow),
    ("绿", Colour::Green),
    ("蓝", Colour::Blue),
    ("紫", Colour::Purple),
    ("粉", Colour::Pink),
    ("棕", Colour::Brown),
    ("米", Colour::Beige),
];
