//! Chinese words by class: things, people, times, and the words in which people speak of a walk and a camera.

/// Words about a walk, clothes and a camera that have a character of a thing in them; longer ones first.
pub const HARMLESS: &str = "
    肩上背 肩上挎 肩背 后背 打住 打左 打右 下打 推镜 拉开 推近 拉近 拉远 拖在 拖后 吊在 提示 提前 聊天室 举例 翻转 打头 推进 坐标 玩转 冲锋衣 羽绒服 登山包 旅行包 山地 同伴机 提醒 江湖 泰山 海量 牛角 鱼贯 猫腰 蛇形 生硬 员工 全员 本人 影像 期间 早晚 日常 晚于 早于 连帽衫 牛仔裤 牛仔 运动裤 棒球衫 双肩包 背包 书包 背着包 个包 了包 风衣 马甲 帽衫 背心 云台 飞行员 操作员 操控员 马上 鸟瞰 海拔 校准 水平线
    水平 水准 地平线 出发 发现 发生 镜头 眼下 眼前 盯着 站立 站着 站定 站在原 站在那 站在这 站住 门清 专门 部门 无人机 飞机视角 机位 机身 江山 老是 老远
    人员 成员 街上 街道 沿街 船型 场景 现场 在场 花了 花费 花去 花掉 花上 花约 共花 天上 天空 朝天 日程 先生成
    走马 山羊绒 灯芯绒 草绿 湖蓝 雪白 桥段 星号 月牙 女式 男式 房顶高 星级 水洗";

/// Characters that name a thing, a person or the weather in nearly every word that has them.
pub const CHARACTERS: &str = "店馆铺厅亭塔桥港厂车船艇树林河湖江海山田雨雪雾雷墙篱栏窗楼屋房寺庙宫狗猫鸟牛羊鸽虫猪鸡鸭鱼伞帽灯牌校巷墓碑坡崖桶柱箱椅凳\
女男孩童婴嫂姐妹弟哥叔伯姨婆爷奶妈爸爹娘妻鞋靴袜裙员商贩拎牵拄扛挎搀骑撑掺辆栋棵盏幢艘匹株堵扇朵季拿春夏秋冬夜晨昏晚午霜冰雹雕菜";

/// Words that name a thing, a person, a time, a company or something else that no facts of a flight have.
pub const THINGS: &str = "
    医院 学院 影院 剧院 寺院 院子 院墙 庭院 公园 花园 花坛 花店 花丛 鲜花 草坪 草地 草丛 草坡 池塘 喷泉 水池 积水 水边 水坑 水沟 码头 广场 操场 市场 球场 商场 机场
    停车场 工地 车站 站台 站牌 公交站 加油站 火车站 地铁站 报刊 银行 超市 餐饮 酒吧 网吧 咖啡馆 报摊 摊位 小摊 路摊 摊贩 大门 门口 门前 门外 校门 阳台 屋顶 天台 台阶 楼梯 电梯 扶梯
    天桥 高架 隧道 地道 通道 涵洞 地铁 铁路 铁轨 轨道 高速 马路 公路 十字路口 路口 街角 街口 拐角 转角 斑马线 人行横道 环岛 岔路 小路口 胡同 弄堂 人行道 自行车道 车道 绿化带 隔离带 护栏
    消防栓 电线杆 旗杆 路灯 红绿灯 信号灯 标志 招牌 广告 长椅 垃圾 雕像 雕塑 塑像 纪念 石头 石墩 花瓶 气球 风筝 皮球 足球 篮球 架飞机 客机 直升机 火车 火箭 摩托 单车 轮椅 轮船
    灌木 树丛 森林 沙滩 沙地 海边 岸边 岸上 小溪 水库 瀑布 农田 悬崖 山坡 村庄 村子 小镇 小区 社区 市区 郊区 城里 街区 大厦 大楼 公寓 宿舍 办公 仓库 工厂 车间 教堂 学校 幼儿 图书 博物
    警察 民警 交警 保安 老师 学生 工人 医生 护士 服务员 快递 外卖 店员 售货 清洁 环卫 厨师 记者 军人 士兵 司机 乘客 游客 旅客 顾客 客人 老人 老头 老太 大爷 大妈 大叔 大娘 阿姨 小伙 小哥 姑娘 少年 青年 青少年 中年
    女士 先生 夫人 太太 爱人 夫妇 夫妻 情侣 恋人 对象牵 朋友 同伴 伙伴 同学 同事 邻居 别人 他人 众人 人们 人群 人流 人潮 人堆 路边的人 母亲 父亲 父母 儿子 女儿 丈夫 老公 老婆 家人 亲人 宠物 小贩 商贩 乞丐 骑手 骑车
    结伴 并肩 作伴 做伴 相伴 搭伴 陪同 陪伴 同行者 挽着 手拉手 手牵手 勾肩 依偎
    日落 日出 太阳 阳光 日光 夕阳 朝阳 月光 月亮 星光 星空 天黑 天亮 白天 凌晨 黄昏 傍晚 上午 下午 时分 昨天 明天 周末 周一 周五 节日 上班 下班 高峰 放学 天气 气温 刮风 大风 有风 迎风 顺风 逆风 微风 风力 台风 狂风 寒风 多云 乌云 白云 云层 晴朗 晴天 阴天 阴沉 炎热 寒冷 打雷 闪电 彩虹 灰尘 沙尘
    眼镜 墨镜 口罩 围巾 手套 头盔 头巾 领带 围裙 皮带 项链 耳环 耳机 手表 拐杖 手杖 手机 电话 行李 公文包 手提包 腰包 钱包 面包 塑料袋 袋子 购物 报纸 杂志 抽烟 吸烟 香烟 咖啡店 奶茶 矿泉水 水瓶 气枪 相框 吉他 婴儿 推车 手推
    头发 长发 短发 卷发 白发 金发 光头 秃头 胡子 胡须 高个 矮个 瘦高 身材 年轻 年迈 年老 岁 手持 肩上 夹在 手里 手上 手中 看书 唱歌 跳舞 聊天 说笑 打电话 跑步 慢跑 奔跑 游泳";

/// Verbs of the hands and of riding, before `着` and `了`; what they have is no part of a walk.
pub const HOLDING: &str = "拿提拎抱捧握举捏叼推拖搀扶挽搂骑坐吃喝啃嚼唱哼聊翻玩打扫喂遛撑牵扛挑踩躲踏";
/// Measure words of people, animals, vehicles and things that stand about.
pub const MEASURES: &str = "名位只辆架艘匹头群队棵座栋所间家株盏把根台伙帮批堆排";
/// Verbs of passing; what they pass must be of the walk.
pub const PASSING: [&str; 30] = [
    "掠过", "驶过", "飞过", "飘过", "开过", "滑过", "闪过", "擦过", "路过", "途经", "途径", "穿过", "越过", "绕过",
    "跨过", "穿越", "横穿", "走进", "走出", "进入", "经过", "走过", "绕开", "避开", "躲开", "跨越", "翻过", "爬上",
    "钻过", "绕着",
];
/// Words before a place.
pub const BEFORE_PLACES: [&str; 20] = [
    "靠近", "挨着", "紧邻", "毗邻", "沿着", "临近", "紧挨", "背靠", "遇到", "遇见", "遇上", "碰到", "碰见", "撞见",
    "面对", "正对", "身处", "紧靠", "贴着", "对着",
];
/// Words behind a place, or before what is there.
pub const BESIDE: [&str; 16] = [
    "旁边", "附近", "边上", "隔壁", "对面", "周围", "四周", "一带", "周边", "身旁", "身边", "底下", "尽头", "近旁",
    "跟前", "之旁",
];
/// Words that make what a place is beside part of the walk.
pub const OF_THE_WALK: [&str; 41] = [
    "掉头",
    "调头",
    "折返",
    "动作",
    "目标",
    "行人",
    "路人",
    "此人",
    "这个人",
    "那个人",
    "对方",
    "双方",
    "两者",
    "彼此",
    "无人机",
    "镜头",
    "画面",
    "视野",
    "米",
    "秒",
    "次",
    "回",
    "弯",
    "转",
    "拐",
    "段",
    "途",
    "路",
    "全程",
    "直线",
    "方向",
    "一侧",
    "度",
    "人物",
    "主角",
    "被摄",
    "被试",
    "前面",
    "拍",
    "这人",
    "那人",
];
/// Words of places in which something is where `有`, `是` or the like follow.
pub const SOMEWHERE: [&str; 14] =
    ["身后", "前方", "前面", "后面", "头顶", "地上", "远处", "左边", "右边", "左侧", "右侧", "路上", "脚边", "上空"];
/// Words of company, where who it is comes before them.
pub const TOGETHER: [&str; 11] =
    ["并排", "并行", "为伴", "结队", "搭伙", "同走", "一起", "一道", "一块儿", "一同", "同行"];
pub const COMPANIONS_BEGIN: [&str; 4] = ["和", "与", "跟", "同"];
/// Measure words of numbers that a walk has; before any other a number counts things.
pub const SOME_OF: [&str; 14] = [
    "来了个",
    "来了位",
    "来了一",
    "来个",
    "有个",
    "有一个",
    "有位",
    "有一位",
    "有名",
    "有一名",
    "有只",
    "有一只",
    "有群",
    "有一群",
];
