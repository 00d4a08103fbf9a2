// Meshes as OBJ, and lists of points.
#include <utility>

#include "tests/fuzz/seeds.h"

namespace animeme::fuzz {

void make_obj(Folder folder) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const std::string inks = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n";
  const std::pair<const char*, std::string> files[] = {
      {"triangle", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"square", square + "f 1 2 3 4\n"},
      {"negative", square + "f -4 -3 -2 -1\n"},
      {"slashes", square + "vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1 4\n"},
      {"weights", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n"},
      {"colours", inks + "f 1 2 3 4\n"},
      {"weights_and_colours", "v 0 0 0 1 1 0 0\nv 1 0 0 1 0 1 0\nv 0 1 0 1 0 0 1\nf 1 2 3\n"},
      {"some_colours", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"objects", "o Head\n" + square + "f 1 2 3\no Eye_Left\nf 2 3 4\no EyeRight\nf 1 3 4\n"},
      {"groups", square + "g skin\nf 1 2 3\ng upper_teeth\nf 2 3 4\ng skin\nf 1 2 4\n"},
      {"materials",
       square + "usemtl Tongue\nf 1 2 3\nusemtl hair.001\nf 2 3 4\nusemtl lashes\nf 1 2 4\n"},
      {"hidden", square + "o occlusion\nf 1 2 3\no cornea\nf 2 3 4\n"},
      {"all_parts",
       square +
           "o skin\nf 1 2 3\no left eye\nf 1 2 3\no right eye\nf 1 2 3\no upper teeth\nf 1 2 3\n"
           "o lower teeth\nf 1 2 3\no tongue\nf 1 2 3\no hair\nf 1 2 3\no brows\nf 1 2 3\n"
           "o lashes\nf 1 2 3\no body\nf 1 2 3\n"},
      {"continued", "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 \\\n3\n"},
      {"windows", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"},
      {"tabs", "v\t0\t0\t0\nv 1  0   0\nv 0 1 0\n\tf 1 2 3\n"},
      {"comments", "# a head\nmtllib a.mtl\ns off\n" + square + "l 1 2\np 1\nf 1 2 3\n"},
      {"numbers", "v 1e3 -2.5E-2 +.5\nv 1. 0x1 0\nv 0 1 0\nf 1 2 3\n"},
      {"not_finite", "v nan inf 0\nv 1e99 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"two_corners", square + "f 1 2\n"},
      {"early", "f 1 2 3\n" + square},
      {"beyond", square + "f 1 2 99999999999999999999\n"},
      {"zero", square + "f 0 1 2\n"},
      {"no_face", square},
      {"no_end", square + "f 1 2 3"},
      {"many_corners", square + "f 1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4\n"},
      {"name_of_spaces", "o   \n" + square + "g a b  c \nf 1 2 3\n"},
      {"empty_line_goes_on", "\\\n\\\n" + square + "f 1 2 3\n"}};
  for (const auto& [name, text] : files) {
    folder.add(name, text);
    folder.add(std::string(name) + "_points",
               text + '\0' + "feature_point,vertex,mesh\n2.1,0,\n8.3,2,Head\n");
    folder.add(std::string(name) + "_places", text + '\0' + "2.1 0.1 0 0\n8.4 1 1 1\n");
  }
}

void make_points(Folder folder) {
  const std::pair<const char*, const char*> files[] = {
      {"heading", "feature_point,vertex\n2.1,0\n8.3,2\n"},
      {"plain", "2.1 0\n8.3 3\n"},
      {"places", "feature_point,x,y,z\n2.1,0.0,-7.57,10.43\n8.3,2.53,-3.52,10.19\n"},
      {"plain_places", "2.1 0 0 0\n8.3 1 1 1\n"},
      {"both", "id,vertex,x,y,z\n2.1,,0,0,1\n8.3,2,,,\n"},
      {"mesh", "point;index;object\n2.1;1;face\n8.3;0;teeth\n8.4;1;skin\n"},
      {"tabs", "point\tvertex\n2.1\t1\n"},
      {"quotes", "\"feature_point\",\"vertex\"\n\"2.1\",\"1\"\n"},
      {"comments", "# landmarks\n2.1 1 # the chin\n\n   \n8.3 2\n"},
      {"windows", "feature_point,vertex\r\n2.1,0\r\n"},
      {"capitals", "FEATURE_POINT,VERTEX\n2.1,0\n"},
      {"names", "name,feature_point,note,vertex\nchin,2.1,,0\n"},
      {"columns_again", "point,point,vertex,vertex,x,x,y,z\n2.1,8.3,0,1,2,3,4,5\n"},
      {"spaced", "2.1   0\n 8.3    2\n"},
      {"no_id", "vertex,x,y,z\n0,1,2,3\n"},
      {"no_number", "2.1,chin\n"},
      {"short_row", "feature_point,mesh,vertex\n2.1\n"},
      {"long_row", "2.1,0,1,2,3,4,5,6\n"},
      {"negative", "2.1,-1\n"},
      {"far", "2.1,4294967295\n8.3,4294967296\n"},
      {"not_finite", "2.1 nan 0 0\n"},
      {"huge", "2.1 1e38 -1e38 1e39\n"},
      {"none", "# nothing\n"},
      {"only_heading", "feature_point,vertex\n"},
      {"no_end", "2.1 0"},
      {"same_again", "2.1 0\n2.1 1\n2.1 2\n"},
      {"unknown", "99.99 0\nchin 1\n3 2\n"},
      {"commas", ",,,\n,\n2.1,,\n"},
      {"mixed_marks", "2.1;0,1\t2\n"}};
  for (const auto& [name, text] : files) folder.add(name, std::string(text));
}

}  // namespace animeme::fuzz
