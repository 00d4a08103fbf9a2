"""Animeme: MPEG-4 facial animation, from recordings or text to a face and its stream.

    import animeme
    clip = animeme.load("talk.fba")                     # .fap .mp4 .csv ... as well
    clip.values, clip.mask                              # (frames, 68) arrays, FAP units
    data = animeme.encode(clip, max_rms=2)              # bytes of an FBA stream
    model = animeme.train(animeme.Corpus("my_corpus", "train"))
    model.speak("Hello world").save("hello.mp4")
    animeme.Head("woman").pose(clip)                    # vertices, (frames, n, 3) cm

Failures are animeme.Error, with code and position. Long calls let other threads run.
"""

from ._types import Error, InputWarning, Phone, Position
from ._animeme import (
    ARKIT_NAMES, FAP_NAMES, VISEME_NAMES, Clip, Corpus, Decoder, Encoder, Evaluation, Head, Model,
    Plane, Sentence, Speech, SpeechStream, VoiceStream, __version__, builtin_model, decode, encode,
    evaluate,
    load, load_model, read, read_script, train, write_script)

__all__ = [
    "ARKIT_NAMES", "FAP_NAMES", "VISEME_NAMES", "Clip", "Corpus", "Decoder", "Encoder", "Error",
    "Evaluation", "Head", "InputWarning", "Model", "Phone", "Plane", "Position", "Sentence",
    "Speech", "SpeechStream", "VoiceStream", "__version__", "builtin_model", "decode", "encode",
    "evaluate",
    "load", "load_model", "read", "read_script", "train", "write_script"]

# So that tracebacks name them as programs do.
for _type in (Error, InputWarning, Phone, Position):
    _type.__module__ = __name__
del _type
