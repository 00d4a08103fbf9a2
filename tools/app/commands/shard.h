/// @file
/// --shard I/N of the commands that do a part of something.
#pragma once

#include <cstdio>
#include <string>

namespace animeme::tools {

/// Reads "2/8"; what is wrong with it, in a sentence; empty: nothing.
inline std::string read_shard(const std::string& text, int& shard, int& shards) {
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%d/%d%n", &shard, &shards, &used);
  const bool good = read == 2 && std::size_t(used) == text.size() && shards >= 1 && shard >= 1 &&
                    shard <= shards && shards <= 100000;
  return good ? "" : "I/N is wanted with I from 1 to N, as 1/4, not " + text;
}

/// The same where the two numbers are not wanted yet.
inline std::string problem_of_shard(const std::string& text) {
  int shard = 0, shards = 0;
  return read_shard(text, shard, shards);
}

}  // namespace animeme::tools
