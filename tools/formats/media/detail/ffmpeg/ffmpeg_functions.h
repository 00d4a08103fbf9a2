// The functions of FFmpeg that we call, as a table of pointers. Internal.
//
// FFmpeg brings 130 shared libraries with it, and loading them takes two thirds of the time of a
// command that needs none of them. So all calls go by way of functions(), of which there are two:
// that of the library (linked.cpp) is linked with FFmpeg like any other; that of the program
// (tools/app/late/ffmpeg_late.cpp) loads animeme_ffmpeg.so with the first call. A function that is
// missing below does not compile into the program: it would be linked at once again (test
// Start.LoadsNoLibraryBeforeItIsNeeded).
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavcodec/bsf.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/channel_layout.h>
#include <libavutil/intreadwrite.h>
#include <libavutil/log.h>
#include <libavutil/mem.h>
#include <libavutil/opt.h>
#include <libavutil/samplefmt.h>
#include <libswresample/swresample.h>
#include <libswscale/swscale.h>
}

// clang-format off
#define ANIMEME_FFMPEG_FUNCTIONS(X) \
  X(av_bsf_alloc) \
  X(av_bsf_free) \
  X(av_bsf_get_by_name) \
  X(av_bsf_init) \
  X(av_bsf_receive_packet) \
  X(av_bsf_send_packet) \
  X(av_channel_layout_copy) \
  X(av_channel_layout_default) \
  X(av_channel_layout_from_mask) \
  X(av_channel_layout_uninit) \
  X(av_compare_ts) \
  X(av_cpb_properties_alloc) \
  X(av_dict_free) \
  X(av_dict_get) \
  X(av_dict_set) \
  X(av_dict_set_int) \
  X(av_find_best_stream) \
  X(av_find_input_format) \
  X(av_frame_alloc) \
  X(av_frame_free) \
  X(av_frame_get_buffer) \
  X(av_frame_unref) \
  X(av_free) \
  X(av_freep) \
  X(av_get_bytes_per_sample) \
  X(av_get_media_type_string) \
  X(av_interleaved_write_frame) \
  X(av_log_default_callback) \
  X(av_log_set_callback) \
  X(av_malloc) \
  X(av_mallocz) \
  X(av_max_alloc) \
  X(av_new_packet) \
  X(av_opt_set) \
  X(av_packet_alloc) \
  X(av_packet_free) \
  X(av_packet_get_side_data) \
  X(av_packet_new_side_data) \
  X(av_packet_rescale_ts) \
  X(av_packet_unref) \
  X(av_read_frame) \
  X(av_reduce) \
  X(av_rescale_q) \
  X(av_rescale_rnd) \
  X(av_sample_fmt_is_planar) \
  X(av_samples_set_silence) \
  X(av_stream_add_side_data) \
  X(av_strerror) \
  X(av_utf8_decode) \
  X(av_write_frame) \
  X(av_write_trailer) \
  X(avcodec_alloc_context3) \
  X(avcodec_find_decoder) \
  X(avcodec_find_encoder) \
  X(avcodec_find_encoder_by_name) \
  X(avcodec_flush_buffers) \
  X(avcodec_free_context) \
  X(avcodec_get_name) \
  X(avcodec_open2) \
  X(avcodec_parameters_alloc) \
  X(avcodec_parameters_copy) \
  X(avcodec_parameters_free) \
  X(avcodec_parameters_to_context) \
  X(avcodec_receive_frame) \
  X(avcodec_receive_packet) \
  X(avcodec_send_frame) \
  X(avcodec_send_packet) \
  X(avformat_alloc_context) \
  X(avformat_alloc_output_context2) \
  X(avformat_close_input) \
  X(avformat_find_stream_info) \
  X(avformat_free_context) \
  X(avformat_new_stream) \
  X(avformat_open_input) \
  X(avformat_write_header) \
  X(avio_alloc_context) \
  X(avio_closep) \
  X(avio_context_free) \
  X(avio_enum_protocols) \
  X(avio_flush) \
  X(avio_open2) \
  X(avio_read_partial) \
  X(avio_size) \
  X(avio_write) \
  X(swr_alloc_set_opts2) \
  X(swr_convert) \
  X(swr_free) \
  X(swr_get_out_samples) \
  X(swr_init) \
  X(sws_freeContext) \
  X(sws_getCoefficients) \
  X(sws_getContext) \
  X(sws_scale) \
  X(sws_setColorspaceDetails)
// clang-format on

namespace animeme::media::av {

struct Functions {
#define ANIMEME_FFMPEG_MEMBER(name) decltype(&::name) name##_;
  ANIMEME_FFMPEG_FUNCTIONS(ANIMEME_FFMPEG_MEMBER)
#undef ANIMEME_FFMPEG_MEMBER
};

/// The table that all calls go by.
const Functions& functions();

/// The addresses of the functions. Callers link with FFmpeg.
inline Functions linked_functions() {
#define ANIMEME_FFMPEG_ADDRESS(name) &::name,
  return {ANIMEME_FFMPEG_FUNCTIONS(ANIMEME_FFMPEG_ADDRESS)};
#undef ANIMEME_FFMPEG_ADDRESS
}

}  // namespace animeme::media::av
