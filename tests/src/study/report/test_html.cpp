// Text that stays text in the pages that tutu writes.
#include "src/study/report/html.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tutu::app;

namespace {

TEST(Base64, IsThatOfTheStandard) { // [RFC 4648, 10]
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Html, NothingInContentIsMarkup) {
  EXPECT_EQ(html_escaped("<a b=\"c\">'&"), "&lt;a b=&quot;c&quot;&gt;&#39;&amp;");
  EXPECT_EQ(html_lines("a\n<b>"), "a<br>\n&lt;b&gt;");
}

TEST(Html, NoTextOfAScriptsDataEndsIt) {
  const std::string hostile = "</script><!--<script>]]>";
  const std::string text = script_value({{hostile, hostile}});
  EXPECT_EQ(text.find('<'), text.npos) << text;
  EXPECT_EQ(nlohmann::ordered_json::parse(text).at(hostile), hostile) << "and it is the same text to the script";
}

} // namespace
