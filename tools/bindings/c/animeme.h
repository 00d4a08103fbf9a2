/// @file
/// Animeme for C: MPEG-4 facial animation, FBA streams, FAP text, speech to faces, ARKit weights.
///
///     animeme_decoder* decoder;
///     animeme_frame frame;
///     animeme_error error;
///     animeme_decoder_new(&decoder, NULL);
///     animeme_frame_init(&frame, sizeof frame);
///     animeme_decoder_push(decoder, bytes, size, NULL);    // any split, as bytes arrive
///     for (;;) {
///       animeme_status status = animeme_decoder_next(decoder, &frame, NULL, &error);
///       if (status == ANIMEME_NEED_DATA || status == ANIMEME_END) break;
///       if (status == ANIMEME_OK) show(frame.present, frame.value);
///       else puts(error.message);                          // continues at the next good plane
///     }
///     animeme_decoder_free(decoder);
///
/// Rules for all functions:
///
/// **Errors.** Functions that can fail return an animeme_status and take an animeme_error as the
/// last argument, which may be NULL and is written only on failure (status below 0). On failure
/// outputs are unchanged, except that output pointers are NULL. An invalid NULL gives
/// ANIMEME_INVALID_ARGUMENT, never a crash. C++ exceptions do not escape.
///
/// **Ownership.** Free a handle with the `_free` function of its type, in any order (a speech keeps
/// what it needs of its model); NULL may be freed. Memory returned through `uint8_t**` or `char**`
/// belongs to the caller; free it with animeme_free(). Memory returned as const belongs to the
/// handle and is valid until the next call with it. Arguments need not outlive the call.
///
/// **Structs** begin with `size`. The `_init` functions set it and the defaults; callers then
/// change members. Later versions append members: the library reads and writes no more than `size`
/// bytes, so programs and libraries of different versions are compatible. A size that is too small
/// is an error, and so is a non-zero member that this library does not know. animeme_error has no
/// size and will never change.
///
/// **Strings** are UTF-8. Arguments with a length need no terminating 0; returned strings have one.
///
/// **Threads.** Use a handle from one thread at a time; different handles may be used concurrently.
/// Models are immutable and may be shared by threads. Functions without a handle may be called from
/// any thread. There is no global state.
///
/// **Input** may be untrusted: streams, texts, scripts and models.
///
/// **Memory** comes from malloc and the C++ library. Decoder, encoder (with or without start codes
/// before all planes), receiver and ARKit handles do not allocate per plane once they have run for
/// three seconds, except for wider ranges and new FAPs.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifndef ANIMEME_API
#if defined(__GNUC__)
#define ANIMEME_API __attribute__((visibility("default")))  ///< exported
#else
#define ANIMEME_API  ///< exported
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// Result of a call. Below 0: errors. Numbers never change; new ones may be added.
typedef int32_t animeme_status;
enum {
  ANIMEME_OK = 0,                 ///< done
  ANIMEME_NEED_DATA = 1,          ///< not an error: push more, or finish
  ANIMEME_END = 2,                ///< not an error: nothing comes after this
  ANIMEME_INVALID_ARGUMENT = -1,  ///< NULL, a setting outside its range, a call out of order
  ANIMEME_SYNTAX = -2,            ///< the input violates its format
  ANIMEME_OUT_OF_RANGE = -3,      ///< well formed, but a value cannot be represented
  ANIMEME_TRUNCATED = -4,         ///< the input ends before it is complete
  ANIMEME_UNSUPPORTED = -5,       ///< legal, but not supported by this version or build
  ANIMEME_NOT_FOUND = -6,         ///< a phone or a channel does not exist
  ANIMEME_IO = -7,                ///< an error of the operating system
  ANIMEME_INTERNAL = -8,          ///< a bug of Animeme; please report it
  ANIMEME_NO_MEMORY = -9          ///< out of memory
};

/// An error.
typedef struct animeme_error {
  animeme_status status;  ///< as returned
  int32_t reserved;       ///< 0
  int64_t line;           ///< of a text, from 1; 0: no text position
  int64_t column;         ///< byte of the line, from 1; 0: the whole line
  int64_t bit;            ///< of a stream, from 0; -1: no stream position
  char message[480];      ///< one sentence after its position; 0-terminated, truncated if necessary
} animeme_error;

#define ANIMEME_FAP_COUNT 68     ///< facial animation parameters 1..68; FAP n is at index n - 1
#define ANIMEME_BAP_COUNT 296    ///< body animation parameters 1..296; BAP n is at index n - 1
#define ANIMEME_GROUP_COUNT 10   ///< FAP groups 1..10; group n is at index n - 1
#define ANIMEME_ARKIT_COUNT 61   ///< 52 blend shapes from 0 to 1, then 9 angles in radians
#define ANIMEME_ARKIT_SHAPES 52  ///< the shapes among them

#define ANIMEME_FRAME_INTRA 1u  ///< decoders can begin here
#define ANIMEME_FRAME_FACE 2u   ///< the plane codes a face, if only an empty one
#define ANIMEME_FRAME_BODY 4u   ///< the plane codes a body

/// A frame of a face. An absent FAP keeps its value, or follows another FAP.
typedef struct animeme_frame {
  uint32_t size;                       ///< sizeof(animeme_frame)
  uint32_t flags;                      ///< ANIMEME_FRAME_... of decoded planes, else 0
  int64_t number;                      ///< at the rate, from 0; gaps are skipped frames
  double seconds;                      ///< presentation time; of decoded planes
  uint32_t rate_num;                   ///< frames in rate_den seconds; of decoded planes
  uint32_t rate_den;                   ///< see rate_num
  int32_t value[ANIMEME_FAP_COUNT];    ///< FAP units: 1/1024 FAPU or 1e-5 rad; 0 if absent
  uint8_t present[ANIMEME_FAP_COUNT];  ///< 1: the frame has this FAP, 0: it does not
  int32_t viseme[4];                   ///< FAP 1: select1, select2 0..14, blend 0..63, def
  int32_t expression[6];  ///< FAP 2: select1, intensity1 0..63, select2, intensity2, init_face, def
  uint8_t group_rule[ANIMEME_GROUP_COUNT];  ///< of absent FAPs: 0 unknown, 1 hold, 2 follow
  uint8_t reserved[10];                     ///< 0
} animeme_frame;

/// A frame of a body.
typedef struct animeme_body {
  uint32_t size;                       ///< sizeof(animeme_body)
  uint32_t reserved;                   ///< 0
  int64_t number;                      ///< as animeme_frame
  int32_t value[ANIMEME_BAP_COUNT];    ///< 1e-5 rad, millimetres for BAP 181..183; 0 if absent
  uint8_t present[ANIMEME_BAP_COUNT];  ///< 1: the frame has this BAP
} animeme_body;

/// Initialises an empty frame: all FAPs absent. `size` is its sizeof, as in all `..._init`.
ANIMEME_API void animeme_frame_init(animeme_frame* frame, size_t size);
/// See animeme_frame_init().
ANIMEME_API void animeme_body_init(animeme_body* body, size_t size);

// ---- the library ----

/// Version of the library at run time: major * 10000 + minor * 100 + patch.
ANIMEME_API uint32_t animeme_version(void);
/// "0.1.0"; static string.
ANIMEME_API const char* animeme_version_text(void);
/// 1 if this build has the feature: "decode", "encode", "text", "fill", "arkit", "speak"; else 0.
ANIMEME_API int32_t animeme_has(const char* feature);
/// "invalid argument" ...; static string.
ANIMEME_API const char* animeme_status_text(animeme_status status);
/// "open_jaw" for 3, NULL outside 1..68; static string.
ANIMEME_API const char* animeme_fap_name(int32_t fap);
/// Frees memory returned by the library; NULL is allowed.
ANIMEME_API void animeme_free(void* memory);

// ---- decoder: push bytes, pull planes ----

typedef struct animeme_decoder animeme_decoder;  ///< of one stream, below 2 MB

/// Creates a decoder for a new stream.
ANIMEME_API animeme_status animeme_decoder_new(animeme_decoder** decoder, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_decoder_free(animeme_decoder* decoder);
/// Resets the decoder: the next byte begins another stream, for example after a seek.
ANIMEME_API animeme_status animeme_decoder_reset(animeme_decoder* decoder, animeme_error* error);
/// Appends bytes, which are copied. `bytes` may be NULL if `size` is 0.
ANIMEME_API animeme_status animeme_decoder_push(animeme_decoder* decoder, const uint8_t* bytes,
                                                size_t size, animeme_error* error);
/// No more bytes will come; what is pushed later is ignored.
ANIMEME_API animeme_status animeme_decoder_finish(animeme_decoder* decoder, animeme_error* error);
/// The next plane: what it codes of the face into `frame`, of the body into `body` (may be NULL).
/// ANIMEME_NEED_DATA: all complete planes were returned. ANIMEME_END: the stream is over. Errors
/// with bit: TRUNCATED, SYNTAX, OUT_OF_RANGE (32 bits), UNSUPPORTED (DCT coding); call again to
/// continue at the next intra plane after a start code.
ANIMEME_API animeme_status animeme_decoder_next(animeme_decoder* decoder, animeme_frame* frame,
                                                animeme_body* body, animeme_error* error);
/// Number of warnings since the start; the last one is written to `last` (may be NULL).
ANIMEME_API int64_t animeme_decoder_warnings(const animeme_decoder* decoder, animeme_error* last);

// ---- clips ----

typedef struct animeme_clip animeme_clip;  ///< frames in memory, at a rate

/// Creates an empty clip with rate_num frames in rate_den seconds, both above 0.
ANIMEME_API animeme_status animeme_clip_new(uint32_t rate_num, uint32_t rate_den,
                                            animeme_clip** clip, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_clip_free(animeme_clip* clip);
/// Appends a frame, whose number must be greater than that of the last one.
ANIMEME_API animeme_status animeme_clip_add(animeme_clip* clip, const animeme_frame* frame,
                                            animeme_error* error);
/// Number of frames; 0 for NULL.
ANIMEME_API size_t animeme_clip_count(const animeme_clip* clip);
/// Frame `index` from 0; OUT_OF_RANGE after the last.
ANIMEME_API animeme_status animeme_clip_get(const animeme_clip* clip, size_t index,
                                            animeme_frame* frame, animeme_error* error);
/// Rate; either may be NULL.
ANIMEME_API animeme_status animeme_clip_rate(const animeme_clip* clip, uint32_t* rate_num,
                                             uint32_t* rate_den, animeme_error* error);
/// Reads FAP text of any origin. Errors with line and column: TRUNCATED, SYNTAX, OUT_OF_RANGE,
/// UNSUPPORTED (not FAP text).
ANIMEME_API animeme_status animeme_clip_from_text(const char* text, size_t length,
                                                  animeme_clip** clip, animeme_error* error);
/// FAP text of version 2.1; `length` (may be NULL) excludes the terminating 0.
ANIMEME_API animeme_status animeme_clip_to_text(const animeme_clip* clip, char** text,
                                                size_t* length, animeme_error* error);
/// Decodes the face of a whole stream; fails at its first error. TRUNCATED if there is no plane.
ANIMEME_API animeme_status animeme_clip_decode(const uint8_t* bytes, size_t size,
                                               animeme_clip** clip, animeme_error* error);

// ---- encoder ----

#define ANIMEME_PRESET_PLAIN 0u  ///< whole clips: all FAPs that occur, in every plane
#define ANIMEME_PRESET_FILE 1u   ///< whole clips: the smallest stream with the same values
#define ANIMEME_PRESET_LIVE 2u   ///< random access points every 2 s, a start code before each plane

/// Options for encoding.
typedef struct animeme_encode_options {
  uint32_t size;         ///< sizeof(animeme_encode_options)
  uint32_t rate_num;     ///< 25; frames in rate_den seconds. animeme_encoder only, clips have one
  uint32_t rate_den;     ///< 1
  int32_t fap_quant;     ///< 1; 0..31, 0: lossless for values up to +-1860
  int32_t bap_quant;     ///< 1; 0..31. animeme_encoder only
  uint32_t start_codes;  ///< before: 0 no planes, 1 intra planes, 2 all planes
  double intra_seconds;  ///< interval of intra planes; 0: where needed
  double max_rms;        ///< clips, above 0: smallest size for this error, FAP units
  double max_bits_per_second;  ///< clips, above 0: smallest error at this bit rate
  double still_below;          ///< clips, above 0: FAPs that move less than this stay still
  uint8_t leave_out;           ///< clips: FAPs that stay at 0 and equal right sides are not coded
  uint8_t extra_intra;         ///< clips: intra planes also where they save bits
  uint8_t skip_still;          ///< clips: planes in which nothing moves are not sent
  uint8_t verify;              ///< 1; decode the result and compare
  uint8_t reserved[4];         ///< 0
} animeme_encode_options;

/// Sets the defaults of a preset; unknown presets are PLAIN.
ANIMEME_API void animeme_encode_options_init(animeme_encode_options* options, size_t size,
                                             uint32_t preset);
/// Encodes a clip; `options` NULL: preset FILE. INVALID_ARGUMENT (no frames, options), UNSUPPORTED
/// (the rate is not k/16 up to 255 15/16, nor that times 1000/1001), OUT_OF_RANGE (a value).
ANIMEME_API animeme_status animeme_clip_encode(const animeme_clip* clip,
                                               const animeme_encode_options* options,
                                               uint8_t** bytes, size_t* size, animeme_error* error);

typedef struct animeme_encoder animeme_encoder;  ///< for a live stream

/// Creates an encoder; `options` NULL: preset LIVE. INVALID_ARGUMENT if they are out of bounds.
ANIMEME_API animeme_status animeme_encoder_new(const animeme_encode_options* options,
                                               animeme_encoder** encoder, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_encoder_free(animeme_encoder* encoder);
/// Encodes a frame, without look-ahead. Absent FAPs keep their value; its number is not used,
/// `skip` frames are skipped after it. `body` may be NULL. Returns the bytes that are complete:
/// with start codes before all planes, those of this plane; they are valid until the next call with
/// `encoder`. `intra` (may be NULL): 1 if receivers can join here. After an error (INVALID_ARGUMENT
/// after the end, OUT_OF_RANGE for a value) the stream is as if the frame had not been passed.
ANIMEME_API animeme_status animeme_encoder_write(animeme_encoder* encoder,
                                                 const animeme_frame* frame,
                                                 const animeme_body* body, uint32_t skip,
                                                 const uint8_t** bytes, size_t* size,
                                                 int32_t* intra, animeme_error* error);
/// The end of the stream; bytes as above. The encoder is then used up.
ANIMEME_API animeme_status animeme_encoder_finish(animeme_encoder* encoder, const uint8_t** bytes,
                                                  size_t* size, animeme_error* error);
/// The frame that receivers have after the last plane, with quantised values.
ANIMEME_API animeme_status animeme_encoder_shown(const animeme_encoder* encoder,
                                                 animeme_frame* frame, animeme_error* error);

// ---- from coded frames to what is shown ----

#define ANIMEME_FILL_INTERPOLATE 1u      ///< clips: interpolate skipped frames
#define ANIMEME_FILL_KEEP_HIGH_LEVEL 2u  ///< keep FAP 1 and 2 beside other FAPs
#define ANIMEME_FILL_EXPAND 4u           ///< FAP 1 and 2 become low-level FAPs
#define ANIMEME_FILL_COMPLETE 8u         ///< FAPs that were never sent are present, at 0

/// A new clip with every frame and every FAP resolved: held, mirrored, following the other lip.
/// `flags`: ANIMEME_FILL_..., may be 0. Absent FAPs obey the group rules of their frames.
/// OUT_OF_RANGE if more than 100,000 frames are missing or a million would be made.
ANIMEME_API animeme_status animeme_clip_fill(const animeme_clip* clip, uint32_t flags,
                                             animeme_clip** filled, animeme_error* error);

typedef struct animeme_receiver animeme_receiver;  ///< fills frame by frame

/// Creates a receiver; `flags` as above.
ANIMEME_API animeme_status animeme_receiver_new(uint32_t flags, animeme_receiver** receiver,
                                                animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_receiver_free(animeme_receiver* receiver);
/// Passes a received frame (NULL: none, the last one is held) and returns the frame to show in
/// `shown`. Both may be the same.
ANIMEME_API animeme_status animeme_receiver_next(animeme_receiver* receiver,
                                                 const animeme_frame* frame, animeme_frame* shown,
                                                 animeme_error* error);
/// Converts FAP 1 and 2 of `frame` to low-level FAPs; its own low-level FAPs take precedence. Both
/// may be the same.
ANIMEME_API animeme_status animeme_expand(const animeme_frame* frame, animeme_frame* expanded,
                                          animeme_error* error);

// ---- ARKit ----

typedef struct animeme_arkit animeme_arkit;  ///< FAPs to weights; remembers the last ones

/// "eyeBlinkLeft" for 0 (the order of Live Link Face), NULL outside 0..60; static string.
ANIMEME_API const char* animeme_arkit_name(int32_t channel);
/// Creates a fitter.
ANIMEME_API animeme_status animeme_arkit_new(animeme_arkit** arkit, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_arkit_free(animeme_arkit* arkit);
/// Fits weights to a frame, which should be complete (see receiver). `weights` has room for
/// `count`, at least ANIMEME_ARKIT_SHAPES; up to ANIMEME_ARKIT_COUNT are written. About 0.1 ms.
ANIMEME_API animeme_status animeme_arkit_fit(animeme_arkit* arkit, const animeme_frame* frame,
                                             float* weights, size_t count, animeme_error* error);
/// Converts `count` weights to FAPs; the other weights are 0.
ANIMEME_API animeme_status animeme_arkit_to_frame(const float* weights, size_t count,
                                                  animeme_frame* frame, animeme_error* error);

// ---- speech to faces; UNSUPPORTED unless animeme_has("speak") ----

typedef struct animeme_model animeme_model;  ///< how a character moves its mouth

/// The built-in model; keep its attribution.
ANIMEME_API animeme_status animeme_model_builtin(animeme_model** model, animeme_error* error);
/// Reads a model file (.dam). SYNTAX, TRUNCATED, UNSUPPORTED (made by a newer version).
ANIMEME_API animeme_status animeme_model_read(const uint8_t* bytes, size_t size,
                                              animeme_model** model, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_model_free(animeme_model* model);
/// The attribution required when the model is redistributed; valid as long as the model.
ANIMEME_API const char* animeme_model_attribution(const animeme_model* model);

/// Options for speech.
typedef struct animeme_speak_options {
  uint32_t size;        ///< sizeof(animeme_speak_options)
  uint32_t rate_num;    ///< 25; frames in rate_den seconds, at most 1000 a second
  uint32_t rate_den;    ///< 1
  uint32_t reserved;    ///< 0
  double style;         ///< 1; 0..1.5, amount of motion
  double sharpness;     ///< 1; 0..3, quickness
  double articulation;  ///< -1; 0..2, clarity of vowels; below 0: that of the model
  double tail;          ///< 0; 0..60 seconds after the script
  double idle_motion;   ///< 1; 0..2, liveliness; 0: brows at "?" only; below: none. animeme_speak()
                        ///< only
  uint64_t seed;        ///< 1; seed of the idle motion
  double look_ahead;    ///< -1; seconds, 0..60; below 0: unlimited. animeme_speech only
  /// "": neutral. NAME or NAME:INTENSITY, ended by 0: "joy", "anger:0.5", "thinking" ... (the names
  /// of `animeme speak --mood`). NOT_FOUND: no such mood; UNSUPPORTED: a model that has neither
  /// FAPs nor ARKit's shapes (then animeme_speech_push() or _finish() fail)
  char mood[32];
  /// "": "camera". Where the eyes look, ended by 0: "camera", "away", "YAW,PITCH" in degrees or
  /// "X,Y,Z" in metres, as `animeme speak --look`. SYNTAX, OUT_OF_RANGE. animeme_speak() only
  char look[32];
  /// "": none. Parts without idle motion, ended by 0: "gaze,head,brows,blinks". NOT_FOUND: no such
  /// part. animeme_speak() only
  char still[32];
  /// 1: FAP 44 to 47 follow the sounds, for models that do not have the tongue; 0: it rests. FAP 47
  /// does not fit into streams with fap_quant 0
  uint32_t tongue;
  /// 0: the resting mouth is the same on both sides; 1: as learned, with the smirk of its speaker
  uint32_t asymmetric_rest;
} animeme_speak_options;

/// Sets the defaults.
ANIMEME_API void animeme_speak_options_init(animeme_speak_options* options, size_t size);
/// The frames for a script of phones and times in any text format (TextGrid, TSV "start_s end_s
/// phone", label files, ...). `options` may be NULL. Errors of the script have line and column.
ANIMEME_API animeme_status animeme_speak(const animeme_model* model, const char* script,
                                         size_t length, const animeme_speak_options* options,
                                         animeme_clip** clip, animeme_error* error);

typedef struct animeme_speech animeme_speech;  ///< incremental speech

/// Starts incremental speech: push phones and get frames as soon as they are final. `options` may
/// be NULL.
ANIMEME_API animeme_status animeme_speech_new(const animeme_model* model,
                                              const animeme_speak_options* options,
                                              animeme_speech** speech, animeme_error* error);
/// See the rules above.
ANIMEME_API void animeme_speech_free(animeme_speech* speech);
/// The next phone: seconds, upper-case ARPAbet without stress or "SIL". Gaps are silence.
/// INVALID_ARGUMENT: it begins before the last one ends, has no duration or is unknown, or the
/// speech has ended.
ANIMEME_API animeme_status animeme_speech_push(animeme_speech* speech, double start, double end,
                                               const char* phone, animeme_error* error);
/// No more phones will come.
ANIMEME_API animeme_status animeme_speech_finish(animeme_speech* speech, animeme_error* error);
/// The next frame; ANIMEME_NEED_DATA: push more; ANIMEME_END: all were returned.
ANIMEME_API animeme_status animeme_speech_next(animeme_speech* speech, animeme_frame* frame,
                                               animeme_error* error);

#ifdef __cplusplus
}
#endif
