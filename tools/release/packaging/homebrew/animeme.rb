# From a tarball on this machine (git archive), as a release has its own url and sha256 in its copy of this file:
#   HOMEBREW_ANIMEME_TARBALL=/path/animeme-0.1.0.tar.xz brew install --formula tools/release/packaging/homebrew/animeme.rb
class Animeme < Formula
  desc "Talking faces from text or speech, as MPEG-4 facial animation"
  url "file://#{ENV.fetch("HOMEBREW_ANIMEME_TARBALL", "/nowhere/animeme-0.1.0.tar.xz")}"
  version "0.1.0"
  # The sources are MIT; espeak-ng, which the program is linked with, asks for the GPL-3.0.
  license all_of: ["MIT", "CC-BY-4.0", "GPL-3.0-or-later"]

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "tomlplusplus" => :build
  depends_on "draco"
  depends_on "espeak-ng"
  depends_on "expat"
  depends_on "ffmpeg"
  depends_on "icu4c"
  depends_on "jpeg-turbo"
  depends_on "libpng"
  depends_on "libwebsockets"
  depends_on "libxml2"
  depends_on "mecab"
  depends_on "mecab-ipadic"
  depends_on "meshoptimizer"
  depends_on "webp"

  uses_from_macos "zlib"

  def install
    # The aligner wants pocketsphinx 0.8, CLD2 and MPI are left out.
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja",
           "-DANIMEME_BUILD_TESTS=OFF", "-DANIMEME_WITH_ALIGNER=OFF", "-DANIMEME_WITH_CLD2=OFF",
           "-DANIMEME_WITH_MPI=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"animeme", "speak", "--text", "Place red at C eight please", "-o", "said.fba"
    system bin/"animeme", "decode", "said.fba", "-o", "said.fap"
    assert_match version.to_s, shell_output("#{bin}/animeme --version")
  end
end
