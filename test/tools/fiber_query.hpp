#pragma once

#include <string>

#include "test/tools/tools_test.hpp"

namespace fiber::test {

inline const std::string columns =
    "fiber_a,segment_a,s,fiber_b,segment_b,t,distance,point_a_x,point_a_y,point_a_z,"
    "point_b_x,point_b_y,point_b_z,normal_x,normal_y,normal_z,lower,upper\n";

class FiberQuery : public ToolsTest {
 protected:
  /// Three fibres: two cross at a gap of 0.1 in their second and first segment, the third is 1
  /// away.
  std::string crossing() const {
    return write("crossing.csv",
                 "fiber,x,y,z,radius\n"
                 "0,-2,0,0,0.2\n0,-1,0,0,0.2\n0,1,0,0,0.2\n"
                 "1,0,-1,0.5,0.2\n1,0,1,0.5,0.2\n"
                 "2,-2,0,1.5,0.2\n2,2,0,1.5,0.2\n");
  }
  std::string soup(const std::string& arguments) const {
    const ProcessResult made = scene("soup " + arguments + " --out " + path("soup.csv"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path("soup.csv");
  }
};

}  // namespace fiber::test
