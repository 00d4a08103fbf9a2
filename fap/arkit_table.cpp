// The effect of each ARKit shape on FAPs, at weight 1.
//
// Measured on ICT-FaceKit (light; University of Southern California, MIT licence): displacement of
// the FAP's feature point along its axis, divided by the FAPU of that head; entries below 10 units
// are dropped (fap/semantics.md, section 10). Where the
// model splits a shape into sides (browInnerUp, cheekPuff), the two are summed. Shapes of the right
// side are not listed: the measured ones are the mirror image of the left, to the unit.
//
// Not as measured:
// - The model's PupilDilate and cheekRaiser are not shapes of ARKit and are left out (the rows of
//   the former give eyeball angles of 2.1 rad, which is the pupil's rim mistaken for a gaze).
// - eyeBlink was 849 + 25 units; the lids of a closed eye have come 1024 units closer (IRISD), so
//   both are scaled by 1024 / 874.
// - mouthShrugUpper differs between the sides by up to 11 units, noise of the mesh: averaged.
// - eyeLook shapes of the model move the lids alone. ARKit's turn the eye: the angle of the eye
//   against the weight rises by 0.61 rad (35 degrees) for Down, 0.55 to 0.63 for In and Out, and
//   0.38 to 0.41 (23 degrees) for Up in two captures of Live Link Face that have both.
// - tongueOut has no shape in the model. A tongue put out as far as it goes reaches about one
//   mouth width beyond its place behind the teeth: FAP 45 = 1024.
// - Angles are radians; signs as found in the same captures (yaw against eyeLookIn and Out, pitch
//   against eyeLookDown and Up). The head was not recorded there; it is taken to turn like the
//   eyes, and its roll to complete the left-handed axes that these signs imply.
#include "fap/arkit_internal.h"

namespace animeme::fap::internal {
namespace {

constexpr ArkitWeight kEyeBlinkLeft[] = {{19, 995}, {21, 29}};
constexpr ArkitWeight kEyeLookDownLeft[] = {{19, 667}, {21, -197}, {25, 61087}};
constexpr ArkitWeight kEyeLookInLeft[] = {{19, 16}, {21, 33}, {23, -61087}};
constexpr ArkitWeight kEyeLookOutLeft[] = {{21, 14}, {23, 61087}};
constexpr ArkitWeight kEyeLookUpLeft[] = {{19, -307}, {21, 153}, {25, -40143}};
constexpr ArkitWeight kEyeSquintLeft[] = {{19, 13}, {21, 198}, {41, 33}};
constexpr ArkitWeight kEyeWideLeft[] = {{19, -309}, {21, 31}};
constexpr ArkitWeight kJawForward[] = {
    {3, 81},   {5, -67}, {10, -57}, {11, -57}, {12, -32}, {13, -32}, {14, 525}, {16, 446}, {17, 14},
    {18, -75}, {39, 27}, {40, 27},  {52, -56}, {57, -39}, {58, -39}, {59, -28}, {60, -28}};
constexpr ArkitWeight kJawLeft[] = {{5, 12},   {6, 110},   {7, -98},  {10, 13},  {11, 15},
                                    {12, 18},  {15, -174}, {16, 39},  {18, 14},  {39, 44},
                                    {40, -39}, {52, 16},   {53, 101}, {54, -91}, {57, 18},
                                    {58, 13},  {59, 18},   {61, 19},  {62, -18}};
constexpr ArkitWeight kJawOpen[] = {
    {3, 1360},   {4, 118},    {5, -1700}, {6, -43},   {7, -43},    {8, 181},   {9, 181},
    {10, -1485}, {11, -1485}, {12, -732}, {13, -732}, {14, -1404}, {16, -934}, {17, -14},
    {18, -1485}, {21, -16},   {22, -16},  {39, -62},  {40, -62},   {41, -41},  {42, -41},
    {51, 114},   {52, -1693}, {53, -58},  {54, -58},  {55, 235},   {56, 235},  {57, -1280},
    {58, -1280}, {59, -635},  {60, -635}, {63, -11}};
constexpr ArkitWeight kMouthClose[] = {
    {3, -189},  {4, 37},    {5, 1844},  {6, 22},    {7, 22},    {8, 18},   {9, 18},
    {10, 1737}, {11, 1737}, {12, 807},  {13, 807},  {14, 122},  {16, 808}, {17, 94},
    {18, 502},  {39, 35},   {40, 35},   {51, 25},   {52, 1515}, {53, 29},  {54, 29},
    {55, -33},  {56, -33},  {57, 1388}, {58, 1388}, {59, 660},  {60, 660}};
constexpr ArkitWeight kMouthFunnel[] = {
    {3, 181},   {4, -263},  {5, -400},  {6, -70},   {7, -70},   {8, -132}, {9, -132},
    {10, -321}, {11, -321}, {12, -12},  {13, -12},  {14, -62},  {16, 320}, {17, 306},
    {18, -224}, {39, -54},  {40, -54},  {51, -293}, {52, -429}, {53, -69}, {54, -69},
    {55, -132}, {56, -132}, {57, -192}, {58, -192}, {63, -15}};
constexpr ArkitWeight kMouthPucker[] = {
    {3, -33},   {4, 16},   {6, -106}, {7, -106}, {8, 43},    {9, 43},    {10, 39},  {11, 39},
    {12, 103},  {13, 103}, {14, 52},  {16, 435}, {17, 334},  {18, 53},   {39, -62}, {40, -62},
    {51, -178}, {52, -91}, {53, -94}, {54, -94}, {55, -120}, {56, -120}, {57, 34},  {58, 34},
    {59, 104},  {60, 104}, {61, -16}, {62, -16}, {63, -25}};
constexpr ArkitWeight kMouthLeft[] = {
    {4, -14},  {5, 46},   {6, 129},  {7, -306},  {8, -79},   {10, 99},   {11, 22}, {12, 243},
    {13, 37},  {14, 45},  {15, -48}, {16, -98},  {17, -134}, {18, 67},   {39, 56}, {40, -116},
    {41, 43},  {51, -40}, {52, 34},  {53, 123},  {54, -313}, {55, -126}, {56, 32}, {57, 157},
    {59, 274}, {60, 19},  {61, 114}, {62, -170}, {63, 15},   {64, -53}};
constexpr ArkitWeight kMouthSmileLeft[] = {{3, -77},  {4, -92},  {5, 90},   {6, 140},  {8, -184},
                                           {9, -57},  {10, 197}, {11, 60},  {12, 474}, {14, 45},
                                           {16, -21}, {17, -55}, {18, 102}, {21, 55},  {39, 95},
                                           {41, 82},  {51, -84}, {52, 97},  {53, 143}, {55, -266},
                                           {56, -17}, {57, 313}, {58, 14},  {59, 507}, {61, 44}};
constexpr ArkitWeight kMouthFrownLeft[] = {
    {3, -25}, {4, 18},   {5, -12}, {6, 37},  {8, 45},  {9, 14},  {10, -37}, {11, -11}, {12, -186},
    {14, 32}, {17, -22}, {18, 24}, {39, 16}, {51, 26}, {53, 38}, {55, 99},  {57, -68}, {59, -221}};
constexpr ArkitWeight kMouthDimpleLeft[] = {
    {3, -26}, {5, 16},  {6, 28},  {8, 20},  {10, 55}, {11, 17}, {12, 132}, {14, 39},  {16, 11},
    {17, 31}, {18, 32}, {39, 48}, {52, 37}, {53, 17}, {55, 25}, {57, 193}, {59, 131}, {61, 17}};
constexpr ArkitWeight kMouthStretchLeft[] = {
    {3, -22}, {6, 141}, {8, 38},  {10, -21}, {12, -127}, {16, -21}, {17, -31},  {18, 65},
    {39, 65}, {51, 20}, {52, 24}, {53, 133}, {55, 63},   {57, -47}, {59, -148}, {61, 16}};
constexpr ArkitWeight kMouthRollLower[] = {
    {3, 13},  {5, 181},   {6, 10},   {7, 10},   {10, 91},  {11, 91},  {12, -47}, {13, -47},
    {14, 20}, {16, -620}, {18, 195}, {52, 449}, {57, 222}, {58, 222}, {59, -17}, {60, -17}};
constexpr ArkitWeight kMouthRollUpper[] = {
    {4, -85}, {6, 18},   {7, 18},  {8, -62}, {9, -62},  {12, 43},  {13, 43}, {17, -536}, {39, 12},
    {40, 12}, {51, 266}, {53, 32}, {54, 32}, {55, 217}, {56, 217}, {59, 24}, {60, 24}};
constexpr ArkitWeight kMouthShrugLower[] = {{3, -394}, {5, 332},  {6, 17},   {7, 17},   {10, 300},
                                            {11, 300}, {12, 113}, {13, 113}, {14, 215}, {16, 267},
                                            {18, 536}, {52, 369}, {53, 14},  {54, 14},  {57, 277},
                                            {58, 277}, {59, 82},  {60, 82}};
constexpr ArkitWeight kMouthShrugUpper[] = {{4, -255},  {8, -204}, {9, -204},  {12, 18},
                                            {13, 18},   {17, 49},  {51, -276}, {55, -153},
                                            {56, -153}, {59, 12},  {60, 12}};
constexpr ArkitWeight kMouthPressLeft[] = {
    {3, -105}, {4, 16},   {5, 45},  {10, 82}, {11, 25}, {12, 75}, {14, 64},  {16, 35},
    {17, -17}, {18, 124}, {39, 11}, {41, 16}, {51, 34}, {52, 74}, {57, 135}, {59, 65}};
constexpr ArkitWeight kMouthLowerDownLeft[] = {{3, 88},    {5, -164},  {10, -202}, {11, -61},
                                               {12, -78},  {14, -59},  {16, -32},  {18, -118},
                                               {52, -160}, {57, -179}, {59, -55}};
constexpr ArkitWeight kMouthUpperUpLeft[] = {
    {4, -184}, {5, 13},    {8, -285},  {9, -89},  {10, 29}, {12, 161}, {17, -14}, {21, 22},
    {41, 44},  {51, -192}, {55, -391}, {56, -25}, {57, 42}, {59, 211}, {61, 36}};
constexpr ArkitWeight kBrowDownLeft[] = {{19, 22}, {31, -38}, {33, -78}, {35, -18}, {37, 30}};
constexpr ArkitWeight kBrowInnerUp[] = {{19, -14}, {20, -14}, {31, 118}, {32, 118}, {33, 59},
                                        {34, 59},  {35, 24},  {36, 24},  {63, 22}};
constexpr ArkitWeight kBrowOuterUpLeft[] = {{19, -45}, {21, 12},  {31, 44},
                                            {32, 11},  {33, 160}, {35, 122}};
constexpr ArkitWeight kCheekPuff[] = {
    {3, -118}, {5, 32},   {6, -53},  {7, -53},  {8, -47},  {9, -47}, {10, 44}, {11, 44}, {12, 72},
    {13, 72},  {14, 94},  {16, 424}, {17, 346}, {18, 124}, {39, 85}, {40, 85}, {41, 53}, {42, 53},
    {51, -36}, {53, -57}, {54, -57}, {55, -72}, {56, -72}, {59, 80}, {60, 80}, {63, 58}};
constexpr ArkitWeight kCheekSquintLeft[] = {{6, 12},   {12, 17},  {17, -24}, {19, 63}, {21, 203},
                                            {31, -10}, {33, -21}, {35, -20}, {39, 14}, {41, 115},
                                            {53, 14},  {55, -23}, {59, 27},  {61, 13}};
constexpr ArkitWeight kNoseSneerLeft[] = {{3, -14},   {4, -171}, {5, 20},    {6, -23},  {8, -289},
                                          {9, -90},   {10, 54},  {11, 17},   {12, 237}, {18, 14},
                                          {21, 110},  {31, -61}, {32, -15},  {33, -48}, {35, -11},
                                          {39, -33},  {41, 108}, {51, -187}, {52, 15},  {53, -19},
                                          {55, -429}, {56, -28}, {57, 98},   {59, 302}, {63, 38}};
constexpr ArkitWeight kTongueOut[] = {{45, 1024}};
constexpr ArkitWeight kHeadYaw[] = {{49, -100000}};
constexpr ArkitWeight kHeadPitch[] = {{48, 100000}};
constexpr ArkitWeight kHeadRoll[] = {{50, -100000}};
constexpr ArkitWeight kLeftEyeYaw[] = {{23, -100000}};
constexpr ArkitWeight kLeftEyePitch[] = {{25, 100000}};
constexpr ArkitWeight kRightEyeYaw[] = {{24, -100000}};
constexpr ArkitWeight kRightEyePitch[] = {{26, 100000}};

constexpr ArkitShape kShapes[] = {{"eyeBlinkLeft", kEyeBlinkLeft},
                                  {"eyeLookDownLeft", kEyeLookDownLeft},
                                  {"eyeLookInLeft", kEyeLookInLeft},
                                  {"eyeLookOutLeft", kEyeLookOutLeft},
                                  {"eyeLookUpLeft", kEyeLookUpLeft},
                                  {"eyeSquintLeft", kEyeSquintLeft},
                                  {"eyeWideLeft", kEyeWideLeft},
                                  {"jawForward", kJawForward},
                                  {"jawLeft", kJawLeft},
                                  {"jawOpen", kJawOpen},
                                  {"mouthClose", kMouthClose},
                                  {"mouthFunnel", kMouthFunnel},
                                  {"mouthPucker", kMouthPucker},
                                  {"mouthLeft", kMouthLeft},
                                  {"mouthSmileLeft", kMouthSmileLeft},
                                  {"mouthFrownLeft", kMouthFrownLeft},
                                  {"mouthDimpleLeft", kMouthDimpleLeft},
                                  {"mouthStretchLeft", kMouthStretchLeft},
                                  {"mouthRollLower", kMouthRollLower},
                                  {"mouthRollUpper", kMouthRollUpper},
                                  {"mouthShrugLower", kMouthShrugLower},
                                  {"mouthShrugUpper", kMouthShrugUpper},
                                  {"mouthPressLeft", kMouthPressLeft},
                                  {"mouthLowerDownLeft", kMouthLowerDownLeft},
                                  {"mouthUpperUpLeft", kMouthUpperUpLeft},
                                  {"browDownLeft", kBrowDownLeft},
                                  {"browInnerUp", kBrowInnerUp},
                                  {"browOuterUpLeft", kBrowOuterUpLeft},
                                  {"cheekPuff", kCheekPuff},
                                  {"cheekSquintLeft", kCheekSquintLeft},
                                  {"noseSneerLeft", kNoseSneerLeft},
                                  {"tongueOut", kTongueOut},
                                  {"headYaw", kHeadYaw},
                                  {"headPitch", kHeadPitch},
                                  {"headRoll", kHeadRoll},
                                  {"leftEyeYaw", kLeftEyeYaw},
                                  {"leftEyePitch", kLeftEyePitch},
                                  {"rightEyeYaw", kRightEyeYaw},
                                  {"rightEyePitch", kRightEyePitch}};

}  // namespace

std::span<const ArkitShape> arkit_shapes() { return kShapes; }

}  // namespace animeme::fap::internal
