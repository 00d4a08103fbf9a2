/// @file
/// A trained model: all data for synthesis and evaluation.
///
///     C*(t) = rest + sd * S(t)
///
/// `rest` and `sd` are per control; S(t), in units of the training standard deviation and relative
/// to the pose of silence, depends on the method:
///
///     method         parameters            S(t)
///     dam            RefinedParameters     blend of curves with corrections by context
///     dam-paper      AnimemeParameters     blend of D_j(u_j) A_j(u_j), u_j = (t - s_j) / d_j
///     cohen-massaro  AnimemeParameters     the same with constants for A: one target per phone
///     mmm            TrajectoryParameters  smooth curve near the means of the phones' states
///     mean           MeanParameters        the mean pose of the training speech
///     viseme         VisemeParameters      linear interpolation between the poses of the phones
///     triphone       TriphoneParameters    mean curves of phones in context, overlapped and added
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dam/signal/closure.h"
#include "dam/signal/limits.h"
#include "fap/rate.h"
#include "fap/result.h"

/// Dominated animeme models: scripts, training, speaking, evaluation.
namespace animeme::dam {

/// The kind of a model. Numbers are part of the file format.
enum class Method : std::uint8_t {
  dam_paper = 1,      ///< dominated animeme models as in the paper
  dam = 2,            ///< refined dominated animeme models
  cohen_massaro = 3,  ///< one target per phone, blended by dominance (M = 0)
  mmm = 4,            ///< smooth trajectories through Gaussians, after Ezzat
  mean = 5,           ///< the mean pose, for any script
  viseme = 6,         ///< linear interpolation of one pose per phone
  triphone = 7,       ///< mean curves of phones in their context
};

/// "dam", "dam-paper", "cohen-massaro", "mmm", "triphone", "viseme", "mean". Empty for values
/// outside the enumeration.
std::string_view method_name(Method method);
/// The method of that name.
std::optional<Method> find_method(std::string_view name);
/// All methods, in the order of listings.
std::span<const Method> methods();

inline constexpr double kMostArticulation = 2;  ///< largest Model::articulation

/// One animation control, in its own units (FAP units for FAPs).
struct Control {
  std::string name;  ///< "fap3_open_jaw", "jawOpen" ...
  double rest = 0;   ///< value of the resting mouth, from the silences
  double mean = 0;   ///< over speech +-0.2 s of the training rows
  double sd = 0;     ///< standard deviation over the same frames, 0: constant control

  friend bool operator==(const Control&, const Control&) = default;
};

/// A phone that the model has learned.
struct PhoneModel {
  std::string label;                ///< upper-case ARPAbet or "SIL"
  std::uint32_t examples = 0;       ///< occurrences in the training rows
  std::uint32_t context_class = 0;  ///< phones of one class are interchangeable as context
  double duration = 0.08;           ///< seconds, geometric mean of the training rows, > 0
  double longest = 0.3;             ///< seconds: longer phones (singing) hold their middle

  friend bool operator==(const PhoneModel&, const PhoneModel&) = default;
};

/// One realisation of a phone (section V-A of the paper).
struct Mode {
  double sigma = 1;                  ///< width of the dominance in local time, > 0
  std::vector<double> coefficients;  ///< a^m of control c is at [m * controls + c]

  friend bool operator==(const Mode&, const Mode&) = default;
};

/// Number of occurrences of a mode between two phones; left and right index Model::phones,
/// kRestContext is the resting mouth or the end of the clip.
struct ContextCount {
  std::int32_t left = 0;    ///< previous phone
  std::int32_t right = 0;   ///< next phone
  std::uint32_t mode = 0;   ///< index of AnimemePhone's modes
  std::uint32_t count = 0;  ///< at least 1

  friend bool operator==(const ContextCount&, const ContextCount&) = default;
};
inline constexpr std::int32_t kRestContext = -1;  ///< the resting mouth, in place of a phone

/// The modes of one phone.
struct AnimemePhone {
  std::vector<Mode> modes;             ///< at least one
  std::vector<ContextCount> contexts;  ///< sorted by left, right, mode

  friend bool operator==(const AnimemePhone&, const AnimemePhone&) = default;
};

/// Largest degree of the polynomials of AnimemeParameters.
inline constexpr int kMaxOrder = 8;

/// Dominated animemes as in the paper.
struct AnimemeParameters {
  std::uint32_t order = 4;           ///< M, degree of the polynomials
  bool normalised = true;            ///< blend by D / sum of D; false: plain sum
  double time_margin = 0.5;          ///< see clamp_local_time(); infinity: free extrapolation
  std::vector<AnimemePhone> phones;  ///< one for each of Model::phones

  friend bool operator==(const AnimemeParameters&, const AnimemeParameters&) = default;
};

// ---- method dam: dam/lipsync.md, section 2; dam/kinds/refined/README.md has the additions ----
//
//     S(t) = sum_j w_j(t) A_j(u_j),   w_j = D_j / sum_i D_i,
//     D_j = strength_p (d_j / usual_p)^e exp(-(before / left_p)^2 - (after / right_p)^2),
//     A_j(u) = sum over terms of sum_m a_m P_m(2 u - 1),   P_m the Legendre polynomials,
//
// u clamped to [-time_margin, 1 + time_margin], e the duration exponent.

/// Fall-off times of the dominance of a phone, and its strength relative to others.
struct PhoneDominance {
  double left = 0.08;   ///< seconds, > 0
  double right = 0.08;  ///< seconds, > 0
  double strength = 1;  ///< > 0

  friend bool operator==(const PhoneDominance&, const PhoneDominance&) = default;
};

/// The terms whose sum is the curve of a phone. The numbers are part of the file format.
enum class RefinedTerm : std::uint8_t {
  phone = 0,          ///< by phone
  class_left = 1,     ///< by class and class of the previous phone
  class_right = 2,    ///< by class and class of the next phone
  phone_left = 3,     ///< by phone and class of the previous phone
  phone_right = 4,    ///< by phone and class of the next phone
  duration = 5,       ///< by phone, times ln(duration / usual duration), limited to +-1
  class_left_2 = 6,   ///< by class and class of the phone but one before
  class_right_2 = 7,  ///< by class and class of the phone but one after
  phone_class = 8,    ///< by class: shared by its rare phones
  left = 9,           ///< by previous phone: its effect on all phones
  right = 10,         ///< by next phone, likewise
  triphone = 11,      ///< by phone and both neighbours: particulars of the corpus
  kind_left = 12,     ///< by vowel, consonant or silence, and the previous phone
  kind_right = 13,    ///< by vowel, consonant or silence, and the next phone
  between = 14,       ///< by class of the previous phone and class of the next phone
  /// By class, times ln(duration / usual duration of the phone), limited to +-1.
  class_duration = 15,
  /// By previous phone, times the same.
  left_duration = 16,
  /// By phone, times ln(duration / usual duration) of the next phone, limited to +-1.
  next_duration = 17,
  since = 18,  ///< all phones, times the seconds since the start of speech, 0 to kLongestSince
  onset = 19,  ///< all phones, times exp(-seconds since the start of speech / 0.3)
};
/// Upper limit of RefinedTerm::since, seconds.
inline constexpr double kLongestSince = 1.5;
/// Largest number of Legendre coefficients of a term.
inline constexpr std::size_t kRefinedOrders = 5;

/// All learned terms of one kind.
struct TermTable {
  RefinedTerm term = RefinedTerm::phone;  ///< which kind
  std::uint32_t orders = 0;               ///< 1..kRefinedOrders
  /// Ascending: phone, class, own (phone, class, kind) * 256 + neighbour (phone or class), or (left
  /// * 256 + own) * 256 + right; 0 if shared by all phones. Kinds: 0 silence, 1 vowel, 2 other.
  std::vector<std::uint32_t> keys;
  std::vector<float> values;  ///< a_m of control c of row r at [(r * orders + m) * controls + c]

  friend bool operator==(const TermTable&, const TermTable&) = default;
};

/// Parameters of method dam; see dam/lipsync.md, section 2.
struct RefinedParameters {
  double time_margin = 0.3;               ///< >= 0
  double duration_exponent = 0.3;         ///< 0..2
  std::vector<PhoneDominance> dominance;  ///< one for each of Model::phones
  std::vector<TermTable> tables;          ///< ascending by term

  friend bool operator==(const RefinedParameters&, const RefinedParameters&) = default;
};

/// Trajectories through Gaussians. A phone has `states` equal parts in time. S(t) of a control
/// minimises the integral of (S - mean)^2 / variance, of the state at t, plus smoothness^(2 *
/// order) times that of the squared derivative of that order.
struct TrajectoryParameters {
  std::uint32_t states = 3;        ///< per phone: 1..8
  std::uint32_t order = 2;         ///< of the derivative: 1..4
  std::vector<double> smoothness;  ///< seconds, per control: 0.001..0.5
  std::vector<double> mean;        ///< [(phone * states + state) * controls + control]
  std::vector<double> variance;    ///< likewise: 1e-4..1e4

  friend bool operator==(const TrajectoryParameters&, const TrajectoryParameters&) = default;
};

/// Empty: S(t) is the mean of Control, relative to rest.
struct MeanParameters {
  friend bool operator==(const MeanParameters&, const MeanParameters&) = default;
};

/// One pose per phone, held for a part of it, with linear interpolation in between.
struct VisemeParameters {
  double place = 0.5;         ///< middle of the hold, in local time: 0..1
  double plateau = 0;         ///< length of the hold, in local time, cut to the phone: 0..1
  std::vector<double> poses;  ///< [phone * controls + control]

  friend bool operator==(const VisemeParameters&, const VisemeParameters&) = default;
};

/// The occurrences averaged in a curve, coarse to fine. Numbers are part of the file format.
enum class CurveLevel : std::uint8_t {
  phone = 0,        ///< all occurrences of a phone
  left_class = 1,   ///< those after a phone of one class (PhoneModel::context_class)
  right_class = 2,  ///< those before a phone of one class
  left = 3,         ///< those after one phone
  right = 4,        ///< those before one phone
  classes = 5,      ///< those between two classes
  triphone = 6,     ///< those between two phones
};
inline constexpr std::size_t kCurveLevels = 7;   ///< values of CurveLevel
inline constexpr std::int32_t kAnyContext = -2;  ///< any neighbour

/// A mean curve, minus those of the coarser levels for the same context.
struct ContextCurve {
  std::int32_t phone = 0;                ///< index of Model::phones
  CurveLevel level = CurveLevel::phone;  ///< how specific its context is
  std::int32_t left = kAnyContext;   ///< phone, class, kRestContext or kAnyContext, as of `level`
  std::int32_t right = kAnyContext;  ///< likewise
  std::uint32_t count = 0;           ///< occurrences, at least 1
  std::vector<float> values;         ///< [point * controls + control]

  friend bool operator==(const ContextCurve&, const ContextCurve&) = default;
};

/// Mean curves of phones in context. The curve of an occurrence is the sum of those of all levels
/// in the table; S(t) is their overlap-add.
struct TriphoneParameters {
  std::uint32_t points = 9;          ///< of a curve, equally spaced: 2..64
  double reach = 0.5;                ///< a curve is over local time -reach..1 + reach: 0.01..0.5
  std::vector<ContextCurve> curves;  ///< sorted by phone, level, left, right

  friend bool operator==(const TriphoneParameters&, const TriphoneParameters&) = default;
};

/// One alternative for each family of methods.
using Parameters = std::variant<AnimemeParameters, RefinedParameters, TrajectoryParameters,
                                MeanParameters, VisemeParameters, TriphoneParameters>;

/// A model with its training statistics; plain data that may be changed.
struct Model {
  Method method = Method::dam_paper;  ///< the kind of its parameters
  double pause_edge = 0.3;  ///< seconds: the part of a pause that belongs to the adjacent speech
  double closure_gap = 25;  ///< FAP units: inner lip gap to which P, B, M close
  /// FAP units: how far F and V raise the inner lower lip (FAP 5) towards the teeth; nullopt:
  /// unknown.
  std::optional<double> lip_tooth_raise;
  std::optional<ClosureDuration>
      closure_duration;           ///< how long P, B and M stay closed; nullopt: unknown
  fap::Rate rate;                 ///< of the training signal
  std::vector<Control> controls;  ///< what it animates; all parameters are in this order
  /// Limits of the controls, in the order of `controls`; empty: all are unlimited. (A list in which
  /// all are unlimited is empty after reading it from a file.)
  std::vector<ControlLimit> limits;
  std::vector<PhoneModel> phones;  ///< sorted by label
  Parameters parameters;           ///< the alternative of the method
  /// SynthesisOptions::articulation that suits it: 0..kMostArticulation. 0, as training leaves it:
  /// it says what it has learned. That of the built-in model is 1, since its face is nobody's whom
  /// it is used for.
  double articulation = 0;
  std::string attribution;  ///< credits required when the model is passed on
  std::string provenance;   ///< how the model was made, free text

  /// Index of a phone by label, -1 if the model does not know it.
  std::int32_t find_phone(std::string_view label) const;
  /// Index of a control by name, -1 if there is none.
  std::int32_t find_control(std::string_view name) const;

  friend bool operator==(const Model&, const Model&) = default;
};

/// Checks every statement above (sizes, ranges, finite numbers, indices). Code::invalid_argument
/// with a sentence that names the first violation. read_model() returns only models that pass.
Result<void> validate(const Model& model);

/// The model file: magic "ANIMEDAM", version 2.2 (2.3 with an articulation), little endian, CRC-32
/// of everything. dam/model/README.md has the layout. The same model gives the same bytes.
std::vector<std::uint8_t> write_model(const Model& model);

/// Safe for untrusted input: sizes are checked against the available bytes before anything is
/// allocated. Errors: syntax (not a model file, damaged), truncated, unsupported (made by a newer
/// major version, or an unknown method).
Result<Model> read_model(std::span<const std::uint8_t> bytes);

/// The same from a path; a file that does not begin like a model is not read further. Additional
/// errors: not_found, io.
Result<Model> load_model(const std::filesystem::path& path);

}  // namespace animeme::dam
