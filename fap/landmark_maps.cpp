// Maps the landmarks of trackers to MPEG-4 feature points.
//
// iBUG 68, numbers from 0, those of the right half of the face (left in the picture) first. If a
// landmark has the same definition as the feature point, it is used directly: chin
// (8), ends and tops of the brows (17 to 26), tip, base and wings of the nose (30, 31, 33, 35),
// corners of the eyes (36, 39, 42, 45), middles and corners of the lips (48, 51, 54, 57, 60, 62,
// 64, 66), cupid's bow (50, 52) and the inner lip halfway (61, 63, 65, 67). These are the landmarks
// that fap/head/face_models.md, section 1, names for 33 points of a head. Estimates:
// - 3.1 to 3.4, centres of the lids: the mean of the two landmarks that each lid has. It lies a
//   little below (above) the middle of the arc, by the same amount in all frames.
// - 8.5 to 8.8, halfway on the outer lip: landmarks are at one and two thirds, so their mean.
// - nasion and 9.12 (bump of the nose) are the two uppermost landmarks of the nose's ridge.
// There are no landmarks for 2.10, the pupils, cheeks, tongue, ears.
//
// MediaPipe, numbers of its canonical face model, whose +X is the person's left too. Lips, chin and
// chin boss are the points that grid_s1 was measured with (channels.tsv there), and equal by name
// to those of iBUG; eyes are the corners and the middles of the rings that MediaPipe draws; pupils
// the centres of the irises (468 right, 473 left). Estimates, by place on the canonical face beside
// the feature points of ICT-FaceKit: brows (ends and third point of the upper row), wings of the
// nose (98, 327), cheeks (207, 427) and cheek bones (50, 280), 9.12 (197), hairline (10: the top of
// the mesh, which ends below the hair).
#include "fap/landmarks.h"

namespace animeme::fap {
namespace {

constexpr LandmarkSource kIbug68[] = {
    {"2.1", 8},      {"2.2", 62},  {"2.3", 66},   {"2.4", 64},     {"2.5", 60},     {"2.6", 63},
    {"2.7", 61},     {"2.8", 65},  {"2.9", 67},   {"3.1", 43, 44}, {"3.2", 37, 38}, {"3.3", 46, 47},
    {"3.4", 40, 41}, {"3.7", 45},  {"3.8", 39},   {"3.11", 42},    {"3.12", 36},    {"4.1", 22},
    {"4.2", 21},     {"4.3", 24},  {"4.4", 19},   {"4.5", 26},     {"4.6", 17},     {"8.1", 51},
    {"8.2", 57},     {"8.3", 54},  {"8.4", 48},   {"8.5", 52, 53}, {"8.6", 49, 50}, {"8.7", 55, 56},
    {"8.8", 58, 59}, {"8.9", 50},  {"8.10", 52},  {"9.1", 35},     {"9.2", 31},     {"9.3", 30},
    {"9.12", 28},    {"9.15", 33}, {kNasion, 27},
};

constexpr LandmarkSource kMediapipe[] = {
    {"2.1", 152},  {"2.2", 13},   {"2.3", 14},  {"2.4", 308},  {"2.5", 78},    {"2.6", 311},
    {"2.7", 81},   {"2.8", 402},  {"2.9", 178}, {"2.10", 199}, {"3.1", 386},   {"3.2", 159},
    {"3.3", 374},  {"3.4", 145},  {"3.5", 473}, {"3.6", 468},  {"3.7", 263},   {"3.8", 133},
    {"3.11", 362}, {"3.12", 33},  {"4.1", 336}, {"4.2", 107},  {"4.3", 334},   {"4.4", 105},
    {"4.5", 300},  {"4.6", 70},   {"5.1", 427}, {"5.2", 207},  {"5.3", 280},   {"5.4", 50},
    {"8.1", 0},    {"8.2", 17},   {"8.3", 291}, {"8.4", 61},   {"8.5", 269},   {"8.6", 39},
    {"8.7", 405},  {"8.8", 181},  {"8.9", 37},  {"8.10", 267}, {"9.1", 327},   {"9.2", 98},
    {"9.3", 4},    {"9.12", 197}, {"9.15", 2},  {"11.1", 10},  {kNasion, 168},
};

}  // namespace

std::span<const LandmarkSource> landmark_sources(LandmarkLayout layout) {
  if (layout == LandmarkLayout::ibug68) return kIbug68;
  return kMediapipe;
}

}  // namespace animeme::fap
